// Numbers as hands type them: units, fractions, feet and inches, and what is refused.
#include "graph/language/typed_number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "graph/check/typed_parameter.h"
#include "graph/document/json.h"
#include "graph/document/named_parameters.h"
#include "graph/library/node_type.h"

namespace fw::typed_number_test {

const LengthUnit &mm = *lengthUnit("mm"), &metre = *lengthUnit("m"), &inch = *lengthUnit("in");

double length(const char* text, const LengthUnit& lengths = mm) {
    const Result<double> number = typedNumber(text, "m", lengths);
    if (!number) ADD_FAILURE() << text << ": " << number.error().message;
    return number ? *number : NAN;
}

std::string refusal(const char* text, const char* unit = "m") {
    const Result<double> number = typedNumber(text, unit, mm);
    return number ? "took it for " + std::to_string(*number) : number.error().message;
}

TEST(TypedNumber, LengthsComeInTheDocumentsUnit) {
    EXPECT_EQ(length("3mm"), 3.0);
    EXPECT_EQ(length("3mm", metre), 0.003);
    EXPECT_EQ(length("2 cm"), 20.0);
    EXPECT_EQ(length("1/4in"), 6.35) << "a quarter of an inch, not one by four inches";
    EXPECT_EQ(length("1/4in", inch), 0.25);
    EXPECT_EQ(length("10/4in"), 63.5);
    EXPECT_EQ(length("1 1/2in"), 38.1);
    EXPECT_EQ(length("1'6\"", inch), 18.0);
    EXPECT_EQ(length("-1'6\"", inch), -18.0) << "both parts of it";
    EXPECT_EQ(length("2*1'6\"", inch), 36.0);
    EXPECT_EQ(length("1ft 6in", inch), 18.0);
    EXPECT_EQ(length("1.5e-3m"), 1.5);
    EXPECT_EQ(length("7"), 7.0) << "in the document's unit";
    EXPECT_EQ(length("500um"), 0.5);
    EXPECT_EQ(length("500µm"), 0.5);
    for (const LengthUnit& unit : lengthUnits())
        EXPECT_EQ(length((std::string("5") + unit.name).c_str(), unit), 5);
}

TEST(TypedNumber, LengthsAreReckonedWith) {
    EXPECT_EQ(length("2cm + 3mm"), 23.0);
    EXPECT_EQ(length("2cm+3"), 23.0);
    EXPECT_EQ(length("2*3mm"), 6.0);
    EXPECT_EQ(length("3mm*2"), 6.0);
    EXPECT_EQ(length("(1+2)cm/4"), 7.5);
    EXPECT_EQ(length("-(1cm - 4mm)"), -6.0);
    EXPECT_EQ(length("5 - 2mm"), 3.0);
    EXPECT_EQ(length("3mm/2mm"), 1.5);
    EXPECT_DOUBLE_EQ(length("sqrt(2)*3mm"), 3 * std::numbers::sqrt2);
    EXPECT_EQ(length("max(2mm, 1/8in)"), 3.175);
    EXPECT_DOUBLE_EQ(length("2*pi/3"), 2 * std::numbers::pi / 3);
}

TEST(TypedNumber, AnglesComeInDegrees) {
    const auto angle = [](const char* text) { return typedNumber(text, "degrees", mm); };
    EXPECT_EQ(*angle("45"), 45.0);
    EXPECT_EQ(*angle("45deg"), 45.0);
    EXPECT_EQ(*angle("45°"), 45.0);
    EXPECT_EQ(*angle("1/8turn"), 45.0);
    EXPECT_DOUBLE_EQ(*angle("pi/4*1rad"), 45.0);
    EXPECT_EQ(*typedNumber("3mm", "any", mm), 3.0);
    EXPECT_EQ(*typedNumber("90deg", "any", mm), 90.0);
}

TEST(TypedNumber, WhatIsNoLengthIsRefusedByName) {
    const auto says = [](const std::string& message, const char* words) {
        EXPECT_NE(message.find(words), std::string::npos) << message;
    };
    says(refusal("3mmm"), "'mmm' is no unit: there are mm, cm, m");
    says(refusal("1/0in"), "division by zero");
    says(refusal("3mm", "degrees"), "'mm' is a length's unit, and this is an angle: write deg");
    says(refusal("3deg"), "'deg' is an angle's unit, and this is a length: write mm");
    says(refusal("3mm", ""), "'mm' is a length's unit, and this is a plain number: leave it out");
    says(refusal("3mm", "m/s"), "this is a number in mm/s: leave it out");
    says(refusal("2cm*3mm"), "comes to no length");
    says(refusal("2/(3mm)"), "comes to no length");
    says(refusal("sqrt(2cm)"), "comes to no length");
    says(refusal("p.x mm"), "");
    for (const char* text :
         {"", "mm", "3mm mm", "3 4mm", "3mm)", "(3mm", "'", "1'6", "1'6'", "µ", "3°°", "\xff"})
        EXPECT_FALSE(typedNumber(text, "m", mm)) << text;
}

TEST(TypedNumber, TheTablesUnitsHaveAPowerAndASign) {
    EXPECT_EQ(lengthPower("m"), 1);
    EXPECT_EQ(lengthPower("m/s²"), 1);
    EXPECT_EQ(lengthPower("m³/s²"), 3);
    EXPECT_EQ(lengthPower("1/m"), -1);
    EXPECT_EQ(lengthPower("degrees/m"), -1);
    for (const char* none : {"", "s", "1/s", "degrees", "color", "any"})
        EXPECT_EQ(lengthPower(none), 0) << none;
    EXPECT_EQ(unitSign("m/s", mm), "mm/s");
    EXPECT_EQ(unitSign("m³/s²", mm), "mm³/s²");
    EXPECT_EQ(unitSign("degrees/m", mm), "°/mm");
    EXPECT_EQ(unitSign("1/m", inch), "/in");
    EXPECT_EQ(unitSign("color", mm) + unitSign("any", mm) + unitSign("", mm), "");
    EXPECT_EQ(withSign(45, "degrees", mm), "45°");
    EXPECT_EQ(withSign(1.25, "m", mm), "1.25 mm");
    // Whatever the table says is one of those.
    for (const NodeType& type : nodeTypes())
        for (const InputSpec& input : type.inputs)
            EXPECT_EQ(lengthPower(input.unit) != 0, unitSign(input.unit, mm).find("mm") != std::string::npos)
                << type.id << "." << input.name << " in " << input.unit;
}

TEST(TypedNumber, ParametersTakeThem) {
    Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "unit": "mm", "nodes": [
        {"id": "ball", "type": "sphere", "inputs": {"radius": 5}},
        {"id": "turned", "type": "rotate", "inputs": {"surface": {"from": "ball"}}},
        {"id": "wall", "type": "parameter", "inputs": {"name": "wall", "value": 1, "max": 9}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "turned"}, "resolution": 32}}],
      "parameters": [{"name": "size", "node": "ball", "input": "radius", "max": 100},
                     {"name": "cells", "node": "out", "input": "resolution"},
                     {"name": "turn", "node": "turned", "input": "angles"}]})",
                                     "", nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    const auto set = [&](const char* name, const char* text) {
        const Done done = setParameter(*graph, name, text);
        return done ? std::string() : done.error().message;
    };
    const auto number = [&](const char* node, const char* input, std::size_t at = 0) {
        return inputNumbers(*graph->node(node), input).at(at);
    };
    EXPECT_EQ(set("size", "1/4in"), "");
    EXPECT_EQ(number("ball", "radius"), 6.35);
    EXPECT_EQ(set("wall", "0.2cm"), "") << "a parameter's node may be any of them";
    EXPECT_EQ(number("wall", "value"), 2.0);
    EXPECT_EQ(set("turn", "1/4turn,0,max(1, 2)"), "");
    EXPECT_EQ(number("turned", "angles"), 90.0);
    EXPECT_EQ(number("turned", "angles", 2), 2.0);
    EXPECT_NE(set("size", "3mmm").find("'3mmm' is no value for the parameter 'size': 'mmm' is no unit"),
              std::string::npos)
        << set("size", "3mmm");
    EXPECT_NE(set("size", "1m").find("from"), std::string::npos) << "1000 is out of its range";
    EXPECT_NE(set("cells", "3mm").find("plain number"), std::string::npos) << set("cells", "3mm");
    EXPECT_NE(set("turn", "3mm,0,0").find("this is an angle"), std::string::npos) << set("turn", "3mm,0,0");
    EXPECT_EQ(number("ball", "radius"), 6.35) << "what is refused changes nothing";
}

}  // namespace fw::typed_number_test
