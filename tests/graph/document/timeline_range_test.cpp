// Property test of rangeBetween(): the range contains a track's values between two times.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "graph/document/timeline.h"

namespace fw::timeline_range_test {

Track randomTrack(std::mt19937_64& random) {
    const auto number = [&](double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); };
    Track track;
    track.closed = random() % 3 == 0;
    double time = number(0.0, 2.0);
    const int count = 1 + int(random() % 6);
    for (int i = 0; i < count; ++i) {
        const double size = random() % 4 ? 5.0 : 1e6;
        Key key{.time = time, .value = {number(-size, size), std::round(number(-1.0, 1.0))}};
        key.interpolation = Interpolation(random() % 3);
        key.ease = Ease(random() % 4);
        key.tangents = Tangents(random() % 4);
        if (random() % 3 == 0) key.in = {number(-30.0, 30.0), number(-30.0, 30.0)};
        if (random() % 3 == 0) key.out = {number(-30.0, 30.0)};
        track.keys.push_back(std::move(key));
        time += random() % 5 ? number(0.05, 3.0) : 1e-4;
    }
    if (track.closed) track.keys.back().value = track.keys.front().value;
    return track;
}

TEST(TimelineRange, ContainsTheValuesBetweenItsTimes) {
    std::mt19937_64 random(1);
    const auto number = [&](double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); };
    const int rounds = std::getenv("FIELDWRIGHT_LONG") ? 50'000 : 2000;
    for (int round = 0; round < rounds; ++round) {
        const Track track = randomTrack(random);
        const auto anyTime = [&] {
            if (random() % 3 == 0) return track.keys[random() % track.keys.size()].time;
            return number(-1.0, track.keys.back().time + 1.0);
        };
        double from = anyTime(), to = random() % 4 ? anyTime() : from + number(0.0, 0.01);
        if (random() % 20 == 0) to = from;
        if (to < from) std::swap(from, to);
        for (std::size_t c = 0; c < 2; ++c) {
            const Interval range = rangeBetween(track, c, from, to);
            for (int i = 0; i <= 200; ++i) {
                const double time = i == 200 ? to : std::min(from + (to - from) * i / 200.0, to);
                const double value = evaluate(track, time)[c];
                // The curve's own rounding, relative to its keys.
                const double slack = 1e-15 * absolute(rangeBetween(track, c, -10.0, 100.0)).hi;
                ASSERT_TRUE(range.lo - slack <= value && value <= range.hi + slack)
                    << value << " at " << time << " is not in [" << range.lo << ", " << range.hi << "] from "
                    << from << " to " << to << ", round " << round;
            }
        }
    }
}

TEST(TimelineRange, IsTheValueAtASingleTime) {
    std::mt19937_64 random(2);
    for (int round = 0; round < 500; ++round) {
        const Track track = randomTrack(random);
        const double time = std::uniform_real_distribution(0.0, track.keys.back().time)(random);
        const double value = evaluate(track, time)[0];
        const Interval range = rangeBetween(track, 0, time, time);
        EXPECT_NEAR(range.lo, value, 1e-9 * (1.0 + std::abs(value)));
        EXPECT_NEAR(range.hi, value, 1e-9 * (1.0 + std::abs(value)));
    }
}

}  // namespace fw::timeline_range_test
