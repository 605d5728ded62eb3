// What a document says about its nodes from outside of them: exposed parameters, tracks of the timeline. They
// follow the nodes through edits. Only nodes of the document, none inside groups, can be referred to.
#pragma once

#include <functional>

#include "editor/document/edits.h"

namespace fw::editor {

/// Where a parameter or a track leads to: a node and an input, which may have ".x" behind it.
using Redirect = std::function<std::optional<Plug>(const Plug&)>;

/// Leads every parameter and every track of an input to what `to` gives for its target; those for which it
/// gives nothing stay as they are.
void redirect(Graph& graph, const Redirect& to);
/// The tracks of the parameter `from` become those of `to`.
void renameParameterTracks(Graph& graph, const std::string& from, const std::string& to);
/// Removes the parameters and tracks whose target is gone since `before`. What led nowhere before stays, for
/// it is somebody's mistake and not ours.
void dropLost(Graph& graph, const Graph& before);

/// Why neither a parameter nor a track can lead to the input; empty if one can: it has a number, or numbers,
/// and no wire.
std::string targetRefusal(const Graph& graph, const Plug& input);

/// The input's name without the component of a track that may follow it, and that component (".x" or "").
std::pair<std::string, std::string> splitTrackInput(const std::string& name);

}  // namespace fw::editor
