// A picture of a graph as a Player of its own makes it, with the validation layer on: any message fails.
#pragma once

#include <gtest/gtest.h>

#include "graph/document/json.h"
#include "runtime/play/player.h"

namespace fw::test {

inline Picture drawnBy(const std::string& graphText, const RenderOptions& options) {
    Result<Graph> graph = parseGraph(graphText, "", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    Result<Device> device = createDevice({.validation = true});
    EXPECT_TRUE(device);
    const auto record = device->record;
    Picture drawn;
    {
        Result<Player> player = Player::create(std::move(*graph), std::move(*device), {});
        EXPECT_TRUE(player) << format(player.error());
        Result<Picture> picture = player->frame(options);
        EXPECT_TRUE(picture) << format(picture.error());
        if (picture) drawn = std::move(*picture);
    }
    for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
    return drawn;
}

}  // namespace fw::test
