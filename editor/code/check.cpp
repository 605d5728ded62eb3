#include "editor/code/check.h"

#include <algorithm>

#include "editor/document/edits.h"
#include "editor/document/paths.h"
#include "graph/check/check.h"

namespace fw::editor::code {

std::vector<Error> findingsOf(Graph graph, std::string_view scope, std::string_view node,
                              std::string_view code) {
    if (!scope.empty() && !graph.group(scope)) return {};
    const Node* before = findNode(nodesOf(graph, scope), node);
    if (!before) return {};
    if (before->code != code) graph = setCode(graph, scope, node, std::string(code));
    std::vector<Error> findings = check(graph);
    const std::pair<std::string, std::string> wanted{scope, node};
    std::erase_if(findings, [&](const Error& each) {
        return each.codeLine == 0 || placeOf(graph, each.node) != wanted;
    });
    // Each instance of a group says the same.
    const auto same = [](const Error& a, const Error& b) {
        return a.codeLine == b.codeLine && a.codeColumn == b.codeColumn && a.message == b.message;
    };
    std::vector<Error> once;
    for (Error& each : findings)
        if (std::ranges::none_of(once, [&](const Error& other) { return same(each, other); }))
            once.push_back(std::move(each));
    return once;
}

std::vector<Mark> marksOf(const Text& text, const std::vector<Error>& findings) {
    std::vector<Mark> marks;
    for (const Error& finding : findings) {
        Spot from = spotOfPlace(text, finding.codeLine, finding.codeColumn);
        const std::string& line = text.lines[std::size_t(from.line)];
        const language::Piece piece = language::pieceAt(line, std::size_t(from.byte));
        const bool open = piece.kind == language::Piece::Kind::openComment ||
                          piece.kind == language::Piece::Kind::openString;
        Spot to{from.line, from.byte + int(open ? std::min<std::size_t>(piece.length, 2) : piece.length)};
        if (from.byte == int(line.size())) {
            // At the end of the code something is missing: below what stands last.
            if (line.empty())
                to = from;
            else
                from = before(text, from);
        }
        marks.push_back(
            {{from, clamped(text, to)}, finding.severity == Error::Severity::error, finding.message});
    }
    return marks;
}

void moveMarks(std::vector<Mark>& marks, const Text& text, uint64_t changes) {
    const std::size_t known = text.splices.size(), count = std::min<std::size_t>(known, std::size_t(changes));
    for (std::size_t i = known - count; i < known; ++i)
        for (Mark& mark : marks)
            if (const Splice& splice = text.splices[i];
                mark.range.from.line >= splice.line + splice.removed) {
                mark.range.from.line += splice.added - splice.removed;
                mark.range.to.line += splice.added - splice.removed;
            }
    for (Mark& mark : marks) {
        mark.range.from = clamped(text, mark.range.from);
        mark.range.to = std::max(mark.range.from, clamped(text, mark.range.to));
    }
}

}  // namespace fw::editor::code
