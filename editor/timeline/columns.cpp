#include "editor/timeline/columns.h"

#include <algorithm>
#include <cmath>

#include "editor/timeline/curves.h"

namespace fw::editor {

namespace {

struct Reach {
    double least, most;
    void add(double value) { least = std::min(least, value), most = std::max(most, value); }
};

void paintColumn(Columns& columns, int column, const Reach& reach, const ValueView& values, uint16_t curve) {
    const float top = (values.y(reach.most) - columns.lo.y) / columns.side,
                bottom = (values.y(reach.least) - columns.lo.y) / columns.side;
    const int begin = std::max(int(std::floor(top)), 0),
              end = std::min(int(std::floor(bottom)) + 1, columns.high);
    if (begin >= end) return;
    const auto at = columns.cells.begin() + std::ptrdiff_t(column) * columns.high;
    std::fill(at + begin, at + end, curve);
}

}  // namespace

Columns emptyColumns(ImVec2 lo, ImVec2 hi, float side) {
    Columns columns;
    columns.lo = {std::floor(lo.x), std::floor(lo.y)};
    columns.side = std::max(std::round(side), 1.0f);
    columns.count = std::max(int(std::ceil((hi.x - columns.lo.x) / columns.side)), 0);
    columns.high = std::max(int(std::ceil((hi.y - columns.lo.y) / columns.side)), 0);
    columns.cells.assign(std::size_t(columns.count) * std::size_t(columns.high), 0);
    return columns;
}

void paintCurves(Columns& columns, const Track& track, const TimeView& times, const ValueView& values,
                 uint16_t first) {
    const double begin = times.time(columns.lo.x);
    std::vector<double> at = evaluate(track, begin);
    auto key = std::lower_bound(track.keys.begin(), track.keys.end(), begin,
                                [](const Key& each, double time) { return each.time < time; });
    std::vector<Reach> reaches(at.size(), Reach{0, 0});
    for (int i = 0; i < columns.count; ++i) {
        for (std::size_t c = 0; c < at.size(); ++c) reaches[c] = {at[c], at[c]};
        const double end = times.time(columns.lo.x + float(i + 1) * columns.side);
        for (; key != track.keys.end() && key->time < end; ++key)
            for (std::size_t c = 0; c < at.size(); ++c) reaches[c].add(key->value[c]);
        at = evaluate(track, end);
        for (std::size_t c = 0; c < at.size(); ++c) {
            reaches[c].add(at[c]);
            paintColumn(columns, i, reaches[c], values, uint16_t(first + c));
        }
    }
}

std::vector<ColumnPiece> piecesOf(const Columns& columns) {
    std::vector<ColumnPiece> pieces;
    std::vector<std::size_t> open, next;  // pieces that reach the column, from the top
    for (int i = 0; i < columns.count; ++i) {
        const uint16_t* cells = columns.cells.data() + std::ptrdiff_t(i) * columns.high;
        const float x = columns.lo.x + float(i) * columns.side;
        std::size_t before = 0;
        for (int y = 0; y < columns.high;) {
            int end = y + 1;
            while (end < columns.high && cells[end] == cells[y]) ++end;
            if (cells[y] != 0) {
                const ColumnPiece piece{{x, columns.lo.y + float(y) * columns.side},
                                        {x + columns.side, columns.lo.y + float(end) * columns.side},
                                        cells[y]};
                while (before < open.size() && pieces[open[before]].lo.y < piece.lo.y) ++before;
                ColumnPiece* same = before < open.size() ? &pieces[open[before]] : nullptr;
                if (same && same->lo.y == piece.lo.y && same->hi.y == piece.hi.y &&
                    same->curve == piece.curve) {
                    same->hi.x = piece.hi.x;
                    next.push_back(open[before]);
                } else {
                    next.push_back(pieces.size());
                    pieces.push_back(piece);
                }
            }
            y = end;
        }
        open.swap(next);
        next.clear();
    }
    return pieces;
}

}  // namespace fw::editor
