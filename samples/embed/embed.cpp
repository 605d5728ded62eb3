// Plays a graph: one line about the mesh for every half second of its timeline. Arguments after the file set
// exposed parameters: embed GRAPH [NAME VALUE]...
#include <fieldwright/runtime/play/player.h>

#include <cstdio>
#include <cstdlib>

int main(int count, char** arguments) try {
    if (count < 2) return std::puts("usage: embed GRAPH [NAME VALUE]..."), 2;
    fw::Result<fw::Player> player = fw::Player::open(arguments[1]);
    if (!player) return std::puts(format(player.error()).c_str()), 1;
    for (int i = 2; i + 1 < count; i += 2)
        if (const fw::Done set = player->set(arguments[i], std::atof(arguments[i + 1])); !set)
            return std::puts(format(set.error()).c_str()), 1;

    for (double time = 0.0; time < player->timeline().length; time += 0.5) {
        player->seek(time);
        const fw::Result<fw::Mesh> mesh = player->mesh();
        if (!mesh) return std::puts(format(mesh.error()).c_str()), 1;
        std::printf("%4.1f s: %zu vertices, %zu triangles\n", time, mesh->positions.size(),
                    mesh->triangleCount());
    }
    return 0;
} catch (const fw::SystemError& error) { return std::puts(error.what()), 3; }
