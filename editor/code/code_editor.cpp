#include "editor/code/code_editor.h"

#include <algorithm>
#include <limits>

#include "editor/document/expression_inputs.h"
#include "editor/document/paths.h"
#include "editor/editor.h"

namespace fw::editor::code {

namespace {

/// The node, if it is still there.
const Node* nodeOf(const Editor& editor) {
    const CodeEditor& code = editor.code;
    const Graph& graph = editor.document.graph();
    if (code.node.empty() || code.document != editor.viewport.document) return nullptr;
    if (!code.scope.empty() && !graph.group(code.scope)) return nullptr;
    const Node* node = findNode(nodesOf(graph, code.scope), code.node);
    return node && roleOf(node->type) == NodeRole::expression ? node : nullptr;
}

/// Puts other words in place of the text as one step, and leaves alone what is the same at both ends, so that
/// the cursor stays where it was.
void become(Text& text, std::string_view wanted) {
    const std::string current = stringOf(text);
    if (current == wanted) return;
    std::size_t head = 0, tail = 0;
    const std::size_t most = std::min(current.size(), wanted.size());
    while (head < most && current[head] == wanted[head]) ++head;
    while (tail < most - head && current[current.size() - 1 - tail] == wanted[wanted.size() - 1 - tail])
        ++tail;
    // Between characters.
    while (head > 0 && head < wanted.size() && (wanted[head] & 0xC0) == 0x80) --head;
    while (head > 0 && head < current.size() && (current[head] & 0xC0) == 0x80) --head;
    while (tail > 0 && (current[current.size() - tail] & 0xC0) == 0x80) --tail;
    newStep(text);
    const Spot cursor = text.cursor;
    replace(text, {spotOf(text, head), spotOf(text, current.size() - tail)},
            wanted.substr(head, wanted.size() - tail - head));
    place(text, cursor);
    newStep(text);
}

std::vector<CodeInput> inputsOf(const NodeBox& box) {
    std::vector<CodeInput> inputs;
    for (const Row& row : box.rows) {
        if (row.output) continue;
        CodeInput input{row.name, row.type ? std::string(typeName(*row.type)) : std::string(), {}};
        const Link* link = row.value ? std::get_if<Link>(&row.value->value) : nullptr;
        input.source = link ? "from " + link->node : valueText(row);
        inputs.push_back(std::move(input));
    }
    return inputs;
}

void show(CodeEditor& code, std::vector<Error> findings) {
    code.findings = std::move(findings);
    code.marks = marksOf(code.text, code.findings);
    code.marked = code.text.version;
}

/// Those about the code of the node.
std::vector<Error> findingsHere(const Editor& editor, const std::vector<Error>& all) {
    const std::pair<std::string, std::string> here{editor.code.scope, editor.code.node};
    std::vector<Error> found;
    for (const Error& each : all)
        if (each.codeLine > 0 && placeOf(editor.document.graph(), each.node) == here) found.push_back(each);
    return found;
}

void askForNames(CodeEditor& code, std::shared_ptr<const std::string> text) {
    std::vector<std::string> inputs;
    for (const CodeInput& input : code.inputs) inputs.push_back(input.name);
    code.reader->ask([text = std::move(text), version = code.text.version, session = code.session,
                      inputs = std::move(inputs)]() -> Aside::Answer {
        auto names = std::make_shared<const NamesOfText>(readNames(*text, version, inputs));
        return [names, session](Editor& in) {
            if (in.code.session == session) in.code.names = names;
        };
    });
}

void askForFindings(Editor& editor, std::shared_ptr<const std::string> text) {
    CodeEditor& code = editor.code;
    code.checker->ask([text = std::move(text), version = code.text.version, session = code.session,
                       graph = editor.graph, scope = code.scope, node = code.node]() -> Aside::Answer {
        auto findings = std::make_shared<std::vector<Error>>(findingsOf(*graph, scope, node, *text));
        return [findings, version, session](Editor& in) {
            CodeEditor& now = in.code;
            // Of a text that is older: another answer is under way.
            if (now.session != session || now.text.version != version) return;
            now.checked = version;
            show(now, *findings);
        };
    });
}

}  // namespace

bool pending(const CodeEditor& editor) { return !editor.node.empty() && !is(editor.text, editor.base); }

bool commit(Editor& editor) {
    CodeEditor& code = editor.code;
    editor.document.end(code.hand);
    if (!pending(code)) return false;
    const Node* node = nodeOf(editor);
    if (!node) {
        code.node.clear();
        return false;
    }
    std::string text = stringOf(code.text);
    editor.document.apply("Change Code", setCode(editor.document.graph(), code.scope, code.node, text));
    code.base = std::move(text);
    code.revision = editor.document.revision();
    newStep(code.text);
    return true;
}

void discard(Editor& editor) {
    become(editor.code.text, editor.code.base);
    editor.code.list.open = false;
}

void takeUp(Editor& editor, const NodeBox& box) {
    CodeEditor& code = editor.code;
    if (code.document == editor.viewport.document && code.edits(editor.canvas.scope, box.node->id)) return;
    commit(editor);
    code.document = editor.viewport.document;
    code.scope = editor.canvas.scope, code.node = box.node->id;
    code.revision = editor.document.revision();
    code.base = box.node->code;
    code.text = textOf(code.base);
    // Lines end in one way only: what comes with another is no change of the user's.
    if (stringOf(code.text) != code.base) code.base = stringOf(code.text);
    code.colouring = {};
    const bool focus = code.view.focus;
    code.view = {};
    code.view.focus = focus;
    code.names.reset();
    code.findings.clear(), code.marks.clear();
    code.asked = code.checked = code.marked = code.named = 0;
    ++code.session;
    code.list = {}, code.renaming = {};
    code.hovered.reset();
}

void keepUp(Editor& editor, const NodeBox& box) {
    CodeEditor& code = editor.code;
    const uint64_t revision = editor.document.revision();
    if (code.revision != revision) {
        // The code was changed elsewhere: by undo, by another program. What is typed stays.
        Text now = textOf(box.node->code);
        if (std::string current = stringOf(now); current != code.base) {
            const bool typed = pending(code);
            code.base = std::move(current);
            if (!typed) become(code.text, code.base);
        }
        code.revision = revision;
    }
    if (code.marked != code.text.version) {
        moveMarks(code.marks, code.text, code.marked == 0 ? 0 : code.text.version - code.marked);
        code.marked = code.text.version;
    }
    if (!code.reader) {
        code.reader = std::make_unique<Aside>([] { Shell::wake(); });
        code.checker = std::make_unique<Aside>([] { Shell::wake(); });
    }
    const bool typed = pending(code);
    std::shared_ptr<const std::string> text;
    if (code.named != code.text.version || code.namedOf != revision) {
        code.inputs = inputsOf(box);
        code.named = code.text.version, code.namedOf = revision;
        text = std::make_shared<const std::string>(stringOf(code.text));
        askForNames(code, text);
    }
    // What is applied the preview checks already.
    const PreviewResult& preview = editor.viewport.shown;
    if (code.asked == code.text.version && code.askedOf == revision) return;
    if (typed) {
        if (!text) text = std::make_shared<const std::string>(stringOf(code.text));
        askForFindings(editor, text);
    } else if (preview.revision == revision) {
        code.checked = code.text.version;
        show(code, findingsHere(editor, preview.findings));
    } else {
        return;
    }
    code.asked = code.text.version, code.askedOf = revision;
}

namespace {

/// What is typed is a hand of the document, so that nothing changes under it unless it is applied first.
void holdTyped(Editor& editor) {
    CodeEditor& code = editor.code;
    Document& document = editor.document;
    if (!pending(code)) return document.end(code.hand);
    if (!document.holds(code.hand)) code.hand = document.begin("Change Code");
    document.hold(code.hand, [&editor] { commit(editor); });
}

}  // namespace

void finish(Editor& editor) {
    CodeEditor& code = editor.code;
    for (Aside* aside : {code.reader.get(), code.checker.get()})
        if (aside)
            if (const Aside::Answer answer = aside->take()) answer(editor);
    if (code.node.empty()) return;
    if (code.document != editor.viewport.document) {
        code.node.clear(), code.large = false;
        return;
    }
    if (code.frame >= ImGui::GetFrameCount() - 1) return holdTyped(editor);
    commit(editor);
    code.view.inside = code.view.focus = false;
    code.list.open = false;
}

double nextFrame(const Editor& editor) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const CodeEditor& code = editor.code;
    if (code.node.empty()) return kNever;
    double next = nextBlink(code.view);
    const double time = now();
    const double hover = code.hoveredFrom + kHoverDelay;
    if (code.hovered && hover > time) next = std::min(next, hover - time + 0.01);
    if (code.wantedUntil > time) next = std::min(next, code.wantedUntil - time + 0.01);
    return next;
}

}  // namespace fw::editor::code
