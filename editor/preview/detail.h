// How much of a picture's detail is given up for it to come soon.
#pragma once

namespace fw::editor {

/// While a hand moves.
struct HeldDetail {
    double scale = 1.0;  ///< of the picture's sides
    int cells = 0;       ///< of the mesh, along its longest side; 0: as many as at rest
    bool operator==(const HeldDetail&) const = default;
};

/// For the next picture after one that took so long, milliseconds, of a mesh that has `full` cells at rest.
/// Pixels are given up first, since most of the time is theirs; and they come back last. What is neither too
/// slow nor far from it stays, so that detail does not waver.
HeldDetail adapted(HeldDetail now, double took, int full);

/// How many of so many cells the first mesh of a graph has, which tapes may take so long for, seconds, with
/// all of them (secondsByTapes()): all, unless half of that would still be too long.
int firstCells(int cells, double seconds);

}  // namespace fw::editor
