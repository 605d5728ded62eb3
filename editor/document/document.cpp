#include "editor/document/document.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <nlohmann/json.hpp>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace fw::editor {

namespace {

using NodePointer = std::shared_ptr<const Node>;
using Place = std::optional<std::array<double, 2>>;

/// Nodes are kept by the block, so that a step on one of a thousand nodes keeps one block of pointers, not a
/// thousand pointers; their places apart, so that a step that moves all of them keeps no more than that.
struct Block {
    std::vector<NodePointer> nodes;  ///< without their places
    std::vector<Place> places;
};
using Blocks = std::vector<std::shared_ptr<const Block>>;
constexpr std::size_t kBlockSize = 32;

struct GroupPart {
    std::shared_ptr<const Group> declared;  ///< without its nodes
    Blocks nodes;
};

/// All but nodes and groups.
struct Rest {
    int version = kFormatVersion;
    std::vector<ExposedParameter> parameters;
    KeptJson extra;
    bool operator==(const Rest&) const = default;
};

struct Section {
    KeptJson json;
    TextPlaces places;
};

}  // namespace

struct Snapshot {
    Blocks nodes;
    std::vector<GroupPart> groups;
    std::shared_ptr<const Rest> rest;
    std::shared_ptr<const Section> scene, timeline, frames;
};

namespace {

// Equality of what is written: 0 and -0, which compare equal, are two texts.

bool same(double a, double b) { return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b); }

bool same(const Json& a, const Json& b) {
    if (a.is_number_float() && b.is_number_float()) return same(a.get<double>(), b.get<double>());
    if (!a.is_structured()) return a == b;
    if (a.type() != b.type() || a.size() != b.size()) return false;
    auto other = b.items().begin();
    for (const auto& [key, value] : a.items()) {
        if ((a.is_object() && key != other.key()) || !same(value, other.value())) return false;
        ++other;
    }
    return true;
}

bool same(const InputValue& a, const InputValue& b) {
    if (a.value.index() != b.value.index() || a.entry != b.entry || !same(a.extra, b.extra)) return false;
    if (const double* number = std::get_if<double>(&a.value)) return same(*number, std::get<double>(b.value));
    const auto* numbers = std::get_if<std::vector<double>>(&a.value);
    if (!numbers) return a.value == b.value;
    return std::ranges::equal(*numbers, std::get<std::vector<double>>(b.value),
                              [](double x, double y) { return same(x, y); });
}

bool same(const Place& a, const Place& b) {
    return a.has_value() == b.has_value() && (!a || (same((*a)[0], (*b)[0]) && same((*a)[1], (*b)[1])));
}

/// Whatever their places are.
bool same(const Node& a, const Node& b) {
    return a.id == b.id && a.type == b.type && a.label == b.label && a.muted == b.muted &&
           a.collapsed == b.collapsed && a.code == b.code && a.group == b.group && same(a.extra, b.extra) &&
           std::ranges::equal(a.inputs, b.inputs, [](const auto& x, const auto& y) {
               return x.first == y.first && same(x.second, y.second);
           });
}

bool same(const Block& a, const Block& b) {
    return std::ranges::equal(a.nodes, b.nodes,
                              [](const auto& x, const auto& y) { return x == y || same(*x, *y); }) &&
           std::ranges::equal(a.places, b.places, [](const Place& x, const Place& y) { return same(x, y); });
}

bool same(const Group& a, const Group& b) {
    return a == b && std::ranges::equal(a.inputs, b.inputs, [](const GroupInput& x, const GroupInput& y) {
               return !x.value || same(*x.value, *y.value);
           });
}

bool same(const Rest& a, const Rest& b) { return a == b && same(a.extra, b.extra); }
bool same(const Section& a, const Section& b) { return same(a.json, b.json); }

/// `value` as the former snapshot holds it, if it does.
template <class T>
std::shared_ptr<const T> shared(const std::shared_ptr<const T>& former, T value) {
    return former && same(*former, value) ? former : std::make_shared<const T>(std::move(value));
}

const NodePointer* nodeAt(const Blocks& blocks, std::size_t index) {
    const std::size_t block = index / kBlockSize;
    return block < blocks.size() && index % kBlockSize < blocks[block]->nodes.size()
               ? &blocks[block]->nodes[index % kBlockSize]
               : nullptr;
}

NodePointer withoutPlace(Node node) {
    node.at.reset();
    return std::make_shared<const Node>(std::move(node));
}

Blocks blocksOf(const std::vector<Node>& nodes, const Blocks& former) {
    std::unordered_map<std::string_view, NodePointer> byId;  // of the former nodes, made when one has moved
    const auto shareable = [&](const Node& node, std::size_t index) -> NodePointer {
        const NodePointer* there = nodeAt(former, index);
        if (there && (*there)->id == node.id) return same(**there, node) ? *there : nullptr;
        if (byId.empty())
            for (const auto& block : former)
                for (const NodePointer& each : block->nodes) byId.try_emplace(each->id, each);
        const auto found = byId.find(node.id);
        return found != byId.end() && same(*found->second, node) ? found->second : nullptr;
    };
    Blocks blocks;
    for (std::size_t begin = 0; begin < nodes.size(); begin += kBlockSize) {
        const std::size_t end = std::min(nodes.size(), begin + kBlockSize);
        Block block;
        block.nodes.reserve(end - begin), block.places.reserve(end - begin);
        for (std::size_t i = begin; i < end; ++i) {
            NodePointer node = shareable(nodes[i], i);
            block.nodes.push_back(node ? std::move(node) : withoutPlace(nodes[i]));
            block.places.push_back(nodes[i].at);
        }
        const std::size_t index = begin / kBlockSize;
        blocks.push_back(index < former.size() ? shared(former[index], std::move(block))
                                               : std::make_shared<const Block>(std::move(block)));
    }
    return blocks;
}

GroupPart partOf(const Group& group, const GroupPart& former) {
    Group declared;
    declared.id = group.id, declared.file = group.file, declared.taken = group.taken;
    declared.inputs = group.inputs, declared.outputs = group.outputs;
    declared.extra = group.extra, declared.place = group.place;
    return {shared(former.declared, std::move(declared)), blocksOf(group.nodes, former.nodes)};
}

std::shared_ptr<const Snapshot> snapshotOf(const Graph& graph, const Snapshot& former) {
    auto made = std::make_shared<Snapshot>();
    made->nodes = blocksOf(graph.nodes, former.nodes);
    for (const Group& group : graph.groups) {
        const auto found = std::ranges::find_if(
            former.groups, [&](const GroupPart& part) { return part.declared->id == group.id; });
        made->groups.push_back(partOf(group, found == former.groups.end() ? GroupPart{} : *found));
    }
    made->rest = shared(former.rest, Rest{graph.version, graph.parameters, graph.extra});
    made->scene = shared(former.scene, Section{graph.scene, graph.scenePlaces});
    made->timeline = shared(former.timeline, Section{graph.timeline, graph.timelinePlaces});
    made->frames = shared(former.frames, Section{graph.frames, {}});
    return made;
}

std::vector<Node> unpacked(const Blocks& blocks) {
    std::vector<Node> nodes;
    nodes.reserve(blocks.size() * kBlockSize);
    for (const auto& block : blocks)
        for (std::size_t i = 0; i < block->nodes.size(); ++i) {
            nodes.push_back(*block->nodes[i]);
            nodes.back().at = block->places[i];
        }
    return nodes;
}

Graph graphOf(const Snapshot& snapshot, std::string path) {
    Graph graph;
    graph.version = snapshot.rest->version;
    graph.nodes = unpacked(snapshot.nodes);
    for (const GroupPart& part : snapshot.groups) {
        graph.groups.push_back(*part.declared);
        graph.groups.back().nodes = unpacked(part.nodes);
    }
    graph.parameters = snapshot.rest->parameters;
    graph.scene = snapshot.scene->json, graph.scenePlaces = snapshot.scene->places;
    graph.timeline = snapshot.timeline->json, graph.timelinePlaces = snapshot.timeline->places;
    graph.frames = snapshot.frames->json;
    graph.extra = snapshot.rest->extra;
    graph.path = std::move(path);
    return graph;
}

template <class T>
bool same(const std::shared_ptr<const T>& a, const std::shared_ptr<const T>& b) {
    return a == b || same(*a, *b);
}

bool same(const Blocks& a, const Blocks& b) {
    return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return same(x, y); });
}

bool same(const Snapshot& a, const Snapshot& b) {
    return same(a.nodes, b.nodes) && same(a.rest, b.rest) && same(a.scene, b.scene) &&
           same(a.timeline, b.timeline) && same(a.frames, b.frames) &&
           std::ranges::equal(a.groups, b.groups, [](const GroupPart& x, const GroupPart& y) {
               return same(x.declared, y.declared) && same(x.nodes, y.nodes);
           });
}

const std::string kNoName;

/// No number is given twice in a process.
uint64_t fresh() {
    static std::atomic<uint64_t> last = 0;
    return ++last;
}

}  // namespace

Document::Document(Graph graph) : current(std::move(graph)), changes(fresh()) {
    steps.push_back({"", snapshotOf(current, Snapshot{})});
    saved = steps.front().after;
}

void Document::push(std::string name, Graph next) {
    auto after = snapshotOf(next, *steps[at].after);
    if (same(*after, *steps[at].after)) return;
    next.path = current.path;
    current = std::move(next);
    changes = fresh();
    steps.resize(at + 1);
    steps.push_back({std::move(name), std::move(after)});
    if (steps.size() > kMostSteps + 1) steps.pop_front();
    at = steps.size() - 1;
}

void Document::apply(std::string name, Graph next) {
    if (std::exchange(hand.changed, false)) push(hand.name, Graph(current));
    push(std::move(name), std::move(next));
    settle();
}

Hand Document::begin(std::string name) {
    settle();
    hand = {.number = Hand(fresh()), .name = std::move(name)};
    return hand.number;
}

bool Document::hold(Hand held, std::function<void()> pending) {
    if (held == Hand::none || held != hand.number) return false;
    hand.asked = true;
    hand.pending = std::move(pending);
    return true;
}

void Document::update(Hand by, Graph next) {
    if (by == Hand::none || by != hand.number) return;
    next.path = current.path;
    current = std::move(next);
    changes = fresh();
    hand.changed = true;
}

void Document::end(Hand by) {
    if (by == Hand::none || by != hand.number) return;
    const Begun ended = std::exchange(hand, {});
    if (ended.changed) push(ended.name, Graph(current));
}

void Document::cancel(Hand by) {
    if (by == Hand::none || by != hand.number) return;
    if (!std::exchange(hand, {}).changed) return;
    current = graphOf(*steps[at].after, std::move(current.path));
    changes = fresh();
}

void Document::settle() {
    const Hand settled = hand.number;
    if (const auto pending = std::exchange(hand.pending, {})) pending();
    end(settled);
}

void Document::settleLost() {
    if (!std::exchange(hand.asked, false)) settle();
}

bool Document::canUndo() const { return !held() && at > 0; }
bool Document::canRedo() const { return !held() && at + 1 < steps.size(); }
const std::string& Document::undoName() const { return canUndo() ? steps[at].name : kNoName; }
const std::string& Document::redoName() const { return canRedo() ? steps[at + 1].name : kNoName; }

bool Document::undo() { return canUndo() && goTo(at - 1); }
bool Document::redo() { return canRedo() && goTo(at + 1); }

bool Document::goTo(std::size_t step) {
    if (held() || step == at || step >= steps.size()) return false;
    at = step;
    current = graphOf(*steps[at].after, std::move(current.path));
    changes = fresh();
    return true;
}

bool Document::unsaved() const {
    if (!saved) return true;
    if (!hand.changed) return !same(*steps[at].after, *saved);
    return !same(*snapshotOf(current, *saved), *saved);
}

void Document::markSaved() { saved = hand.changed ? snapshotOf(current, *steps[at].after) : steps[at].after; }

void Document::markUnsaved() {
    saved.reset();
    changes = fresh();  // for whoever keeps what is unsaved
}

void Document::outdate() { changes = fresh(); }

void Document::setPath(std::string path) {
    if (path == current.path) return;
    current.path = std::move(path);
    changes = fresh();
}

}  // namespace fw::editor
