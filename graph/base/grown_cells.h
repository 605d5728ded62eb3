// The cells of a square or a cube, found by halving it along each axis down to single cells: what a part
// learns of itself narrows down what its own parts look at. All processors take part, and the order of what
// is found does not depend on them.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "graph/base/parallel.h"

namespace fw {

/// What `leaf(part, leaves)` adds for each single cell of `whole`, in their order. `split(part, take)` calls
/// take() with each half-sized part that is needed; a part has a `side`, so many cells. After `splittings`
/// halvings the parts are shared out among processors, from where on both are called at once.
template <class Leaf, class Part, class Split, class MakeLeaf>
std::vector<Leaf> grownCells(Part whole, int splittings, const Split& split, const MakeLeaf& leaf) {
    std::vector<Part> parts;
    parts.push_back(std::move(whole));
    for (int round = 0; round < splittings && !parts.empty() && parts.front().side > 1; ++round) {
        std::vector<Part> smaller;
        for (const Part& part : parts) split(part, [&](Part half) { smaller.push_back(std::move(half)); });
        parts = std::move(smaller);
    }
    const auto grow = [&](const auto& self, const Part& part, std::vector<Leaf>& leaves) -> void {
        if (part.side > 1)
            split(part, [&](const Part& half) { self(self, half, leaves); });
        else
            leaf(part, leaves);
    };
    std::vector<std::vector<Leaf>> grown(parts.size());
    forBlocks(parts.size(), 1,
              [&](std::size_t i, std::size_t, std::size_t) { grow(grow, parts[i], grown[i]); });
    std::vector<Leaf> all;
    for (std::vector<Leaf>& some : grown)
        for (Leaf& one : some) all.push_back(std::move(one));
    return all;
}

}  // namespace fw
