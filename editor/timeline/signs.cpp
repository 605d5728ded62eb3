#include "editor/timeline/signs.h"

#include <algorithm>
#include <cmath>

namespace fw::editor {

std::vector<KeySign> signsOf(std::span<const KeyMark> marks, float apart) {
    std::vector<KeySign> signs;
    for (const KeyMark& mark : marks) {
        if (!signs.empty()) {
            KeySign& before = signs.back();
            if (before.chosen && !mark.chosen && mark.x - before.last < 0.5f * apart) continue;
            if (before.chosen == mark.chosen && mark.x - before.last < apart) {
                before.last = mark.x;
                continue;
            }
        }
        signs.push_back({mark.x, mark.x, mark.chosen});
    }
    return signs;
}

std::vector<std::size_t> thinned(std::span<const PointMark> marks, ImVec2 lo, ImVec2 hi, float side) {
    const int columns = std::max(int(std::ceil((hi.x - lo.x) / side)), 1),
              rows = std::max(int(std::ceil((hi.y - lo.y) / side)), 1);
    std::vector<bool> taken(std::size_t(columns) * std::size_t(rows), false);
    std::vector<std::size_t> kept;
    for (const bool chosen : {true, false})
        for (std::size_t i = marks.size(); i-- > 0;) {
            const PointMark& mark = marks[i];
            if (mark.chosen != chosen) continue;
            const int column = int(std::floor((mark.at.x - lo.x) / side)),
                      row = int(std::floor((mark.at.y - lo.y) / side));
            if (column < 0 || row < 0 || column >= columns || row >= rows) continue;
            const std::size_t cell = std::size_t(row) * std::size_t(columns) + std::size_t(column);
            if (taken[cell]) continue;
            taken[cell] = true;
            kept.push_back(i);
        }
    std::ranges::sort(kept);
    return kept;
}

}  // namespace fw::editor
