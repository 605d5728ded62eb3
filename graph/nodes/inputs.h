// Shorthands for the tables of this folder: the kinds of input that many nodes have, each with its type, unit
// and range. Not for use outside graph/nodes/.
#pragma once

#include "graph/nodes/node_types.h"

namespace fw {

/// What shapes and whatever changes them put out.
inline const std::vector<OutputSpec> kSurface = {{"surface", Type::surface}};

inline InputDefault numbers(std::vector<double> values) {
    return {InputDefault::Kind::numbers, std::move(values), {}};
}

/// Where a shape is evaluated: the context position unless wired.
inline InputSpec positionInput() {
    return {.name = "p",
            .type = Type::vec3,
            .value = {InputDefault::Kind::position, {}, {}},
            .unit = "m",
            .doc = "Where the shape is looked up; wire a changed position here to bend or repeat space."};
}

/// A surface that another node makes; nothing (empty space) if unconnected.
inline InputSpec surfaceInput(std::string name, std::string doc) {
    return {.name = std::move(name), .type = Type::surface, .value = {}, .doc = std::move(doc)};
}

/// The same, whether light passes through it or not: of what cuts, is in the way, or is painted anew.
inline InputSpec asWhole(InputSpec input) {
    input.whole = true;
    return input;
}

/// A length of at least 0.
inline InputSpec length(std::string name, double value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::scalar,
            .value = numbers({value}),
            .min = 0,
            .unit = "m",
            .doc = std::move(doc)};
}

/// A length or coordinate that can be taken hold of in space (Grip); of a vector the lengths along the axes.
inline InputSpec gripped(std::array<double, 3> along, InputSpec input, std::string from = {}) {
    input.grip = {.kind = input.type == Type::scalar ? Grip::Kind::length : Grip::Kind::sizes,
                  .along = along,
                  .from = std::move(from)};
    return input;
}
/// A length along the direction that another input is.
inline InputSpec grippedAlong(std::string direction, InputSpec input) {
    input.grip = {.kind = Grip::Kind::length, .with = std::move(direction)};
    return input;
}
/// An angle that turns `along` towards `towards`, held at the end of a length, or a metre from the middle.
inline InputSpec grippedAngle(std::array<double, 3> along, std::array<double, 3> towards, InputSpec input,
                              std::string length = {}, std::array<double, 3> middle = {0, 0, 0}) {
    input.grip = {.kind = Grip::Kind::angle,
                  .along = along,
                  .towards = towards,
                  .middle = middle,
                  .with = std::move(length)};
    return input;
}
/// A direction that begins at the end of another grip, or at the origin.
inline InputSpec grippedDirection(InputSpec input, std::string from = {}) {
    input.grip = {.kind = Grip::Kind::direction, .from = std::move(from)};
    return input;
}
/// A corner of a box, of which another input is the opposite one.
inline InputSpec grippedCorner(InputSpec input, std::string opposite) {
    input.grip = {.kind = Grip::Kind::corner, .with = std::move(opposite)};
    return input;
}
inline constexpr std::array<double, 3> kRight = {1, 0, 0}, kUp = {0, 1, 0}, kDown = {0, -1, 0},
                                       kToEye = {0, 0, 1}, kEach = {1, 1, 1};

/// A length above 0.
inline InputSpec positiveLength(std::string name, double value, std::string doc) {
    InputSpec input = length(std::move(name), value, std::move(doc));
    input.positive = true;
    return input;
}

/// Three lengths of at least 0, along x, y and z.
inline InputSpec lengths(std::string name, std::vector<double> value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::vec3,
            .value = numbers(std::move(value)),
            .min = 0,
            .unit = "m",
            .doc = std::move(doc)};
}

/// A length, place or height that may be negative.
inline InputSpec coordinate(std::string name, double value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::scalar,
            .value = numbers({value}),
            .unit = "m",
            .doc = std::move(doc)};
}

/// A point or a displacement.
inline InputSpec place(std::string name, std::vector<double> value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::vec3,
            .value = numbers(std::move(value)),
            .unit = "m",
            .doc = std::move(doc)};
}

/// A direction; its length does not matter.
inline InputSpec direction(std::string name, std::vector<double> value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::vec3,
            .value = numbers(std::move(value)),
            .doc = std::move(doc)};
}

/// An angle in degrees within a range.
inline InputSpec angle(std::string name, double value, double min, double max, std::string doc) {
    return {.name = std::move(name),
            .type = Type::scalar,
            .value = numbers({value}),
            .min = min,
            .max = max,
            .unit = "degrees",
            .doc = std::move(doc)};
}

/// A plain number of any size.
inline InputSpec scalar(std::string name, double value, std::string doc) {
    return {.name = std::move(name), .type = Type::scalar, .value = numbers({value}), .doc = std::move(doc)};
}

/// A number in another unit than its kind says.
inline InputSpec measured(InputSpec input, std::string unit) {
    input.unit = std::move(unit);
    return input;
}

/// A number that is whatever its node is wired to: a length, an angle, a share.
inline InputSpec anything(InputSpec input) { return measured(std::move(input), "any"); }

/// A share between 0 and 1.
inline InputSpec share(std::string name, double value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::scalar,
            .value = numbers({value}),
            .min = 0,
            .max = 1,
            .doc = std::move(doc)};
}

/// A vector of plain numbers.
inline InputSpec vector(std::string name, std::vector<double> value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::vec3,
            .value = numbers(std::move(value)),
            .doc = std::move(doc)};
}

/// A colour, linear sRGB, each channel at least 0.
inline InputSpec color(std::string name, std::vector<double> value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::vec3,
            .value = numbers(std::move(value)),
            .min = 0,
            .unit = "color",
            .doc = std::move(doc)};
}

/// A line with colours along it: a position, and red, green and blue, of each.
inline InputSpec stops(std::string name, std::vector<double> value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::stops,
            .value = numbers(std::move(value)),
            .doc = std::move(doc)};
}

/// A whole number within a range.
inline InputSpec integer(std::string name, int value, int min, int max, std::string doc) {
    return {.name = std::move(name),
            .type = Type::integer,
            .value = numbers({double(value)}),
            .min = double(min),
            .max = double(max),
            .doc = std::move(doc)};
}

/// A switch.
inline InputSpec toggle(std::string name, bool value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::boolean,
            .value = numbers({value ? 1.0 : 0.0}),
            .min = 0,
            .max = 1,
            .doc = std::move(doc)};
}

/// One of several words; the first is the default.
inline InputSpec choice(std::string name, std::vector<std::string> options, std::string doc) {
    InputDefault first{InputDefault::Kind::text, {}, options.front()};
    return {.name = std::move(name),
            .type = Type::string,
            .value = std::move(first),
            .options = std::move(options),
            .doc = std::move(doc)};
}

/// A picture; a grey checker if none is named.
inline InputSpec picture(std::string name, const std::string& more = "") {
    return {
        .name = std::move(name),
        .type = Type::image,
        .value = {InputDefault::Kind::text, {}, ""},
        .doc = "The picture's path, from the folder of the graph's file; a grey checker if there is none." +
               more,
        .file = &kPictureFile};
}

/// A file that must be named.
inline InputSpec fileInput(std::string name, const FileKind& kind) {
    return {.name = std::move(name),
            .type = Type::string,
            .value = {InputDefault::Kind::text, {}, ""},
            .doc = "The file's path, from the folder of the graph's file.",
            .file = &kind};
}

/// A number that must be known when the graph is compiled.
inline InputSpec known(InputSpec input) {
    input.known = true;
    return input;
}

/// A file that may be named.
inline InputSpec optionalFile(std::string name, const FileKind& kind, std::string doc) {
    InputSpec input = fileInput(std::move(name), kind);
    input.doc = std::move(doc);
    return input;
}

/// A text that may have several lines.
inline InputSpec linesInput(std::string name, std::string value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::string,
            .value = {InputDefault::Kind::text, {}, std::move(value)},
            .doc = std::move(doc),
            .lines = true};
}

/// Any text.
inline InputSpec textInput(std::string name, std::string value, std::string doc) {
    return {.name = std::move(name),
            .type = Type::string,
            .value = {InputDefault::Kind::text, {}, std::move(value)},
            .doc = std::move(doc)};
}

}  // namespace fw
