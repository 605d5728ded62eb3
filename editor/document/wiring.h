// What may be wired to what, for many questions about one graph: a canvas asks for every socket under the
// mouse. The functions of edits.h of the same names answer one question each.
//
// Lifetime: refers to the graph, which must outlive it and not change.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

class Wiring {
  public:
    /// The nodes of the document, or of the group with the id `scope`; none if it is gone.
    Wiring(const Graph& graph, std::string_view scope);
    Wiring(const Wiring&) = delete;
    Wiring& operator=(const Wiring&) = delete;

    const Scope& scope() const { return its; }
    std::optional<uint32_t> find(std::string_view node) const;
    /// The output, if there is one; without a type if that is known only when the graph is compiled.
    std::optional<Socket> output(const Plug& plug) const;
    std::optional<Socket> input(const Plug& plug) const;
    /// What feeds the input; nullptr if nothing does.
    const Link* source(const Plug& input) const;

    std::string refusal(const Plug& output, const Plug& input) const;
    /// The sockets that a wire from this one could lead to: those of which refusal() has nothing to say.
    std::set<Plug> partners(const Plug& plug, bool plugIsOutput) const;
    /// The same for a value of this type, or of one known only to the compiler, from a node that is not there
    /// yet.
    std::string typeRefusal(std::optional<Type> from, const Plug& input) const;
    std::optional<Plug> fittingInput(const Plug& output, std::string_view node) const;
    std::optional<Plug> fittingOutput(std::string_view node, const Plug& input) const;
    /// Whether a new node of this type has a socket for the plug.
    bool fits(const NodeType& type, const Plug& plug, bool plugIsOutput) const;

    /// The link that leads from this output, written as files have it: without the name of an only output.
    Link linkFrom(const Plug& output) const;

  private:
    /// refusal(), but for cycles.
    std::string mismatch(const Plug& output, const Plug& input) const;
    std::string typeRefusal(std::optional<Type> from, uint32_t node, std::string_view name,
                            std::vector<uint32_t>& rerouted) const;

    const Groups groups;
    const Scope its;
};

/// Whether a node of this type may be added to the scope: an output only where there is none yet, a group's
/// ends only in a group.
bool canAdd(const Graph& graph, std::string_view scope, const NodeType& type);

/// Makes an input have its default again. An expression has none: its code would no longer know the name, so
/// it gets zeros, as many as what fed it gave.
void unlink(Node& node, std::string_view input, std::optional<Type> fed);

}  // namespace fw::editor
