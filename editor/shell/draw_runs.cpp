#include "editor/shell/draw_runs.h"

#include <algorithm>
#include <cmath>

namespace fw::editor {

namespace {

double areaOf(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c) {
    const double x = double(b.pos.x - a.pos.x), y = double(b.pos.y - a.pos.y), u = double(c.pos.x - a.pos.x),
                 v = double(c.pos.y - a.pos.y);
    return 0.5 * std::abs(x * v - y * u);
}

void addRun(std::vector<DrawRun>& runs, const DrawRun& next) {
    if (!runs.empty() && runs.back().opaque == next.opaque)
        runs.back().count += next.count;
    else
        runs.push_back(next);
}

}  // namespace

void cutIntoRuns(const ImDrawList& list, const ImDrawCmd& command, const ImVec2* white,
                 std::vector<DrawRun>& runs) {
    runs.clear();
    const ImDrawVert* const vertices = list.VtxBuffer.Data + command.VtxOffset;
    const ImDrawIdx* const indices = list.IdxBuffer.Data + command.IdxOffset;
    const auto opaque = [&](const ImDrawVert& vertex) {
        return (vertex.col & IM_COL32_A_MASK) == IM_COL32_A_MASK &&
               (!white || (vertex.uv.x == white->x && vertex.uv.y == white->y));
    };
    const double seen = std::max(double(command.ClipRect.z - command.ClipRect.x), 0.0) *
                        std::max(double(command.ClipRect.w - command.ClipRect.y), 0.0);
    DrawRun run;
    double area = 0.0;
    const auto end = [&] {
        if (run.count == 0) return;
        if (area < kLeastOpaque) run.opaque = false;
        addRun(runs, run);
    };
    for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
        const ImDrawVert &a = vertices[indices[i]], &b = vertices[indices[i + 1]],
                         &c = vertices[indices[i + 2]];
        const bool all = opaque(a) && opaque(b) && opaque(c);
        if (run.count == 0 || all != run.opaque) {
            end();
            run = {i, 0, all};
            area = 0.0;
        }
        run.count += 3;
        if (all) area += std::min(areaOf(a, b, c), seen);
    }
    end();
}

}  // namespace fw::editor
