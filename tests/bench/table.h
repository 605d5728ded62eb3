// Tables of figures for a terminal or for a page, and the figures in them.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "runtime/system/clock.h"

namespace fw::bench {

/// Several measurements of one thing.
struct Figure {
    std::vector<double> runs;  ///< ascending
    double median() const { return runs[runs.size() / 2]; }
    double least() const { return runs.front(); }
    double greatest() const { return runs.back(); }
};

/// Calls `run`, which returns what it measured, twice to warm up and then `repeats` times.
template <class Run>
Figure measure(int repeats, Run&& run) {
    Figure figure;
    run();
    run();
    for (int i = 0; i < repeats; i++) figure.runs.push_back(run());
    std::sort(figure.runs.begin(), figure.runs.end());
    return figure;
}

/// "12.3": three significant digits, without an exponent.
std::string number(double value);
/// "12.3 (11.9 – 14.0)": median, least and greatest.
std::string text(const Figure& figure);
/// "71 936"
std::string count(uint64_t value);

struct Table {
    std::string title;
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows = {};
    std::vector<std::string> notes = {};  ///< sentences below the table
};

/// Prints to standard output, the first column to the left and the others to the right.
void print(const Table& table, bool markdown);

}  // namespace fw::bench
