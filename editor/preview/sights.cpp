#include "editor/preview/sights.h"

#include <algorithm>
#include <bit>

namespace fw::editor {

namespace {

bool isTold(Sight& sight) {
    sight.best = sight.refined;
    sight.told = std::make_shared<const Picture>(sight.picture);
    return true;
}

}  // namespace

void Sight::outdate(Clock::time_point now) {
    if (!due) changed = now;
    due = true;
}

void Sight::forget(Clock::time_point now) {
    told = nullptr;
    rests = false;
    outdate(now);
}

bool aimSights(std::vector<Sight>& sights, const std::vector<PreviewEye>& eyes, Clock::time_point now) {
    bool any = false;
    const std::size_t before = sights.size();
    sights.resize(eyes.size());
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        if (i < before && sights[i].eye == eyes[i]) continue;
        sights[i].eye = eyes[i];
        sights[i].outdate(now);
        any = true;
    }
    return any;
}

std::optional<std::size_t> nextSight(const std::vector<Sight>& sights, std::size_t first, std::size_t turned,
                                     bool refines, bool settled) {
    const auto there = [&](std::size_t i) { return i < sights.size() && sights[i].wanted(); };
    if (there(first) && sights[first].due) return first;
    std::optional<std::size_t> longest;
    for (std::size_t i = 0; i < sights.size(); ++i)
        if (there(i) && sights[i].due && (!longest || sights[i].changed < sights[*longest].changed))
            longest = i;
    if (longest || !refines) return longest;
    if (!settled && there(first) && !sights[first].rests) return first;
    for (std::size_t i = 0; i < sights.size(); ++i)
        if (there(i) && sights[i].rough) return i;
    for (const std::size_t i : {first, turned})
        if (there(i) && !sights[i].rests) return i;
    for (std::size_t i = 0; i < sights.size(); ++i)
        if (there(i) && !sights[i].rests) return i;
    return std::nullopt;
}

std::optional<std::size_t> staleSight(const std::vector<Sight>& sights, std::size_t first,
                                      Clock::time_point now) {
    std::optional<std::size_t> longest;
    for (std::size_t i = 0; i < sights.size(); ++i)
        if (i != first && sights[i].wanted() && sights[i].due && now - sights[i].changed > kLongestStale &&
            (!longest || sights[i].changed < sights[*longest].changed))
            longest = i;
    return longest;
}

bool isDrawnOf(Sight& sight, const SightOf& of) {
    if (!sight.due) return false;
    if (sight.told && sight.of == of) {
        sight.due = false;
        return true;
    }
    sight.rests = false;
    sight.refined = sight.best = 0;
    return false;
}

bool takeDrawn(Sight& sight) {
    const bool fresh = sight.due || sight.rough;
    sight.due = sight.rough = false;
    ++sight.refined;
    if (fresh || (std::has_single_bit(unsigned(sight.refined)) && sight.refined > sight.best))
        return isTold(sight);
    return false;
}

void takeSketch(Sight& sight) {
    sight.due = false, sight.rough = true;
    sight.refined = 0;
    isTold(sight);
}

bool takeSame(Sight& sight, const std::vector<Sight>& sights, const SightOf& of) {
    const auto has = [&](const Sight& each) {
        return each.of == of && !each.rough && !each.picture.pixels.empty();
    };
    if (!has(sight))
        if (const auto same = std::find_if(sights.begin(), sights.end(), has); same != sights.end())
            sight.picture = same->picture, sight.told = nullptr;
    sight.of = of;
    sight.due = sight.rough = false;
    sight.rests = true;
    return (!sight.told || sight.refined > sight.best) && isTold(sight);
}

bool takeRest(Sight& sight) { return sight.refined > sight.best && isTold(sight); }

}  // namespace fw::editor
