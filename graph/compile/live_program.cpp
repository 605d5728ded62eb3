#include "graph/compile/live_program.h"

#include <utility>

#include "graph/document/named_parameters.h"

namespace fw {

std::vector<double> LiveProgram::valuesAt(double seconds) const {
    std::vector<double> values = program.parameters();
    const double time = timelineTime(timeline, seconds);
    const auto place = [&](const Input& input, const std::vector<double>& numbers) {
        for (std::size_t c = 0; c < input.slots.size(); ++c)
            if (input.slots[c] >= 0) values[static_cast<std::size_t>(input.slots[c])] = numbers[c];
    };
    for (const auto& [name, input] : inputs) place(input, input.value);
    std::map<std::string, std::vector<double>> moved;  // several tracks may move one vector
    for (const Motion& motion : motions) {
        const std::string name = motion.input.node + "." + motion.input.input;
        const Input& input = inputs.at(name);
        std::vector<double>& numbers = moved.try_emplace(name, input.value).first->second;
        applyTrack(motion.track, motion.input, time, numbers);
        place(input, numbers);
    }
    for (std::size_t slot = 0; slot < values.size(); ++slot)
        if (program.live[slot].name == "time") values[slot] = time;
    return values;
}

std::vector<Interval> LiveProgram::rangesBetween(double from, double to) const {
    std::vector<Interval> ranges;
    for (const double value : program.parameters()) ranges.push_back({value, value});
    std::map<std::string, std::vector<Interval>> moved;  // several tracks may move one vector
    const auto place = [&](const Input& input, const std::vector<Interval>& numbers) {
        for (std::size_t c = 0; c < input.slots.size(); ++c)
            if (input.slots[c] >= 0) ranges[static_cast<std::size_t>(input.slots[c])] = numbers[c];
    };
    for (const auto& [name, input] : inputs) {
        std::vector<Interval>& numbers = moved[name];
        for (const double value : input.value) numbers.push_back({value, value});
        place(input, numbers);
    }
    for (const Motion& motion : motions) {
        const std::string name = motion.input.node + "." + motion.input.input;
        applyTrackRange(motion.track, motion.input, from, to, moved.at(name));
        place(inputs.at(name), moved.at(name));
    }
    for (std::size_t slot = 0; slot < ranges.size(); ++slot)
        if (program.live[slot].name == "time") ranges[slot] = {from, to};
    return ranges;
}

Result<LiveProgram> compileLive(Graph graph, CompileOptions options, const std::set<std::string>& exposed) {
    LiveProgram made;
    Result<Timeline> timeline = readTimeline(graph);
    if (!timeline) return timeline.error();
    made.timeline = std::move(*timeline);
    options.live.merge(animatedInputs(graph, made.timeline));
    options.live.insert("time");
    options.moments.clear();
    for (const double time : momentsOf(made.timeline)) {
        auto& values = options.moments.emplace_back();
        values["time"] = {time};
        for (const Track& track : made.timeline.tracks) {
            const std::optional<AnimatedInput> input = animatedInput(graph, track);
            if (!input) continue;
            const auto [numbers, fresh] = values.try_emplace(input->node + "." + input->input);
            if (fresh) numbers->second = inputNumbers(*graph.node(input->node), input->input);
            applyTrack(track, *input, time, numbers->second);
        }
    }
    const std::set<std::string> moving = options.live;
    options.live.insert(exposed.begin(), exposed.end());
    Result<Program> program = compile(graph, options);
    if (!program && options.live != moving) {
        // Some code asks for a parameter's value when it is compiled: then a change compiles.
        options.live = moving;
        program = compile(graph, options);
    }
    if (!program) return program.error();
    made.program = std::move(*program);

    const std::vector<LiveParameter>& live = made.program.live;
    made.read.assign(live.size(), false);
    for (IrId id = 0; id < made.program.ir.size(); ++id)
        if (made.program.ir[id].op == Op::parameter)
            made.read.at(static_cast<std::size_t>(made.program.ir[id].number)) = true;
    for (const FieldVolumePtr& volume : made.program.ir.volumes())
        made.fieldMoves = made.fieldMoves || volume->particles;
    for (std::size_t slot = 0; slot < live.size(); ++slot) {
        const std::size_t dot = live[slot].name.rfind('.');
        const Node* node = dot == std::string::npos ? nullptr : graph.node(live[slot].name.substr(0, dot));
        if (!node) {  // the time, or an input within a group
            made.fieldMoves = made.fieldMoves || (dot == std::string::npos && made.read[slot]);
            continue;
        }
        LiveProgram::Input& input = made.inputs[live[slot].name];
        if (input.value.empty()) input.value = inputNumbers(*node, live[slot].name.substr(dot + 1));
        input.slots.resize(input.value.size(), -1);
        input.slots.at(static_cast<std::size_t>(live[slot].component)) = static_cast<int>(slot);
    }
    for (const Track& track : made.timeline.tracks) {
        const std::optional<AnimatedInput> input = animatedInput(graph, track);
        const auto found = input ? made.inputs.find(input->node + "." + input->input) : made.inputs.end();
        if (found == made.inputs.end()) continue;
        made.motions.push_back({track, *input});
        for (const int slot : found->second.slots)
            made.fieldMoves = made.fieldMoves || (slot >= 0 && made.read[static_cast<std::size_t>(slot)]);
    }
    made.graph = std::move(graph);
    return made;
}

}  // namespace fw
