#include "tests/bench/fields.h"

namespace fw::bench {

std::string_view fieldName(Field field) {
    switch (field) {
        case Field::tower: return "tower";
        case Field::menger: return "menger";
        case Field::gyroid: return "gyroid";
        default: return "csg";
    }
}

std::string benchSample(const std::string& name) {
    return FIELDWRIGHT_BENCH_GRAPHS "/../../../samples/" + name + ".field.json";
}

std::string benchGraph(Field field) {
    return std::string(FIELDWRIGHT_BENCH_GRAPHS "/") + std::string(fieldName(field)) + ".field.json";
}

}  // namespace fw::bench
