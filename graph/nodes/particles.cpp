// Particles: where they come from, what moves them, and the fields that are made of them.
#include "graph/compile/graph_lowering.h"
#include "graph/compile/particle_recipe.h"
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> particleNodes() {
    const InputSpec particles = {
        .name = "particles", .type = Type::particles, .value = {}, .doc = "The particles to take."};
    const auto amount = [&](std::string name, double value, const char* unit, std::string doc) {
        InputSpec input = scalar(std::move(name), value, std::move(doc));
        input.min = 0;
        input.unit = unit;
        return input;
    };
    const auto corner = [](std::string name, std::string doc) {
        return InputSpec{
            .name = std::move(name), .type = Type::vec3, .value = {}, .unit = "m", .doc = std::move(doc)};
    };
    const InputSpec gravity =
        measured(vector("gravity", {0, -9.81, 0}, "The acceleration of everything."), "m/s²");
    const InputSpec collide =
        asWhole(surfaceInput("collide",
                             "What is in the way: any surface, which may move with the time "
                             "and then pushes a fluid. A fluid leaks "
                             "through walls much thinner than its spacing."));
    const InputSpec cache = [] {
        InputSpec input = fileInput("cache", kParticleCacheFile);
        input.doc =
            "A particle cache that fieldwright simulate wrote, read in place of simulating as long as it is "
            "of "
            "this simulation: the path of its particles.cache, from the folder of the graph's file.";
        return input;
    }();
    const InputSpec seed = integer("seed", 0, 0, 1'000'000, "Another number gives other chances.");
    return {
        {.id = "emitter",
         .label = "Emitter",
         .category = Category::particles,
         .doc = "Gives off particles, from the start of the timeline on.",
         .inputs = {choice("shape", {"ball", "box", "disc", "point"},
                           "Where particles begin: anywhere in a ball, in a box, on a disc across the y "
                           "axis, or in one "
                           "point."),
                    place("position", {0, 0, 0}, "The middle of the shape."),
                    gripped(kEach,
                            lengths("size", {0.1, 0.1, 0.1}, "Half the shape's extents along x, y and z."),
                            "position"),
                    amount("rate", 1000, "1/s", "Particles a second."),
                    integer("burst", 0, 0, 1'000'000, "Particles that are there at the start."),
                    measured(positiveLength("lifetime", 2, "How long a particle lives."), "s"),
                    measured(vector("velocity", {0, 2, 0}, "How particles set off."), "m/s"),
                    amount("spread", 0.5, "m/s", "How much the velocity varies, at most, in any direction."),
                    seed, cache},
         .outputs = {{"particles", Type::particles}},
         .lower = lowerEmitter,
         .aliases = {"fountain", "particle_system"}},
        {.id = "particle_file",
         .label = "Particle file",
         .category = Category::particles,
         .doc =
             "Reads particles from a file: the vertices of a mesh's file, points of a .vtk or .bgeo file, or "
             "x, y "
             "and z in each line of a text, whose first line may name the columns, in the folder of the "
             "graph's file or in one below it. Or a sequence of such files, one for every frame: a path as "
             "splash/####.ply, with # for each digit of the number, or %04d. File n is shown from n / fps "
             "on; where one lacks, the one before. What moves the particles of one file begins with the "
             "velocities that it has.",
         .inputs = {fileInput("path", kParticleFile),
                    [&] {
                        InputSpec input = amount("fps", 30, "1/s", "Files a second, of a sequence.");
                        input.positive = true;
                        return input;
                    }()},
         .outputs = {{"particles", Type::particles}},
         .lower = lowerParticleFile,
         .aliases = {"point_cloud"}},
        {.id = "particle_dynamics",
         .label = "Particle dynamics",
         .category = Category::particles,
         .doc = "Moves particles by forces, and lets them collide with any surface. Steps are a sixtieth of "
                "a second.",
         .inputs = {particles, gravity,
                    amount("drag", 0, "1/s",
                           "How fast the air takes their speed: the share that goes in a second, about."),
                    amount("turbulence", 0, "m/s²", "The strength of a swirling wind."),
                    positiveLength("turbulence_size", 0.5, "The size of its swirls."),
                    place("attractor", {0, 0, 0}, "A place that pulls."),
                    measured(
                        scalar("attraction", 0, "How much it pulls, at every distance; negative pushes."),
                        "m/s²"),
                    collide,
                    length("radius", 0.0, "How near a particle's centre may come to what it collides with."),
                    share("bounce", 0.3, "How much of the speed against a surface comes back."),
                    share("friction", 0.1, "How much of the speed along a surface is lost."), cache},
         .outputs = {{"particles", Type::particles}},
         .lower = lowerParticleDynamics,
         .aliases = {"forces"}},
        {.id = "sph_fluid",
         .label = "Fluid",
         .category = Category::particles,
         .doc = "Water: fills a surface with particles at the start, and lets them flow within a tank and "
                "around what is in the "
                "way. Particles keep their density by moving apart, some times in each step.",
         .inputs =
             {asWhole(surfaceInput(
                  "source",
                  "Where there is fluid at the start; it may reach beyond the tank, and into what "
                  "is in the way.")),
              positiveLength(
                  "spacing", 0.05,
                  "Between particles: the fluid's finest detail. Half of it means eight times as many."),
              measured(vector("velocity", {0, 0, 0}, "How the fluid moves at the start."), "m/s"), gravity,
              amount("viscosity", 2, "1/s",
                     "How fast neighbours come to move alike: 0.5 for water, 20 for honey."),
              amount("tension", 0, "m³/s²",
                     "Of the surface, over the density: drops get round. Water has 0.00007, which is seen in "
                     "drops of millimetres; a drop of radius R swings with a period of 2.2 √(R³ / tension)."),
              amount("vorticity", 0, "1/s",
                     "How much swirls are fed, against what the solver loses of them."),
              collide,
              grippedCorner(
                  place("tank_min", {-1, 0, -1}, "Lowest corner of the tank, which the fluid cannot leave."),
                  "tank_max"),
              grippedCorner(place("tank_max", {1, 2, 1}, "Highest corner of the tank."), "tank_min"),
              choice("neighbours", {"fast", "exact"},
                     "How a particle feels its far neighbours: fast, as they were when the step began; or "
                     "exact, in every "
                     "turn of the step."),
              integer("substeps", 0, 0, 64,
                      "Parts of a step of a sixtieth of a second; 0: as many as a fall through the tank, and "
                      "what moves in it, ask for."),
              share(
                  "error", 0,
                  "How much too dense the fluid may be, on average, where a part of a step ends: 0.002 is "
                  "hardly seen to sink. It takes as many turns as that asks for; 0: always the same number."),
              integer("turns", 0, 0, 256,
                      "How often particles move apart in a part of a step; where an error is given, at most. "
                      "0: four times, or up to 32 where an error is given."),
              asWhole(surfaceInput("inflow",
                                   "Where fluid comes in, as from a tap: its particles begin at the side of "
                                   "it from which they come, and as many as its cross-section and their "
                                   "speed ask for. It must be in the tank, and thicker than they move in a "
                                   "sixtieth of a second.")),
              measured(vector("inflow_velocity", {0, -1, 0}, "How what flows in moves."), "m/s"),
              asWhole(surfaceInput("outflow", "Where fluid leaves: particles in it are taken away.")),
              integer("most", 200'000, 1, 4'000'000,
                      "Particles at a time, at most: beyond it, nothing flows in."),
              cache},
         .outputs = {{"particles", Type::particles}},
         .lower = lowerFluid,
         .aliases = {"water", "liquid", "fluid"}},
        {.id = "foam",
         .label = "Spray, foam and bubbles",
         .category = Category::particles,
         .doc =
             "What a fluid gives off where it is torn, and that alone: spray, which flies; foam, which "
             "floats on the fluid; bubbles, which rise in it. It does nothing to the fluid, and does not "
             "leave its tank: spray ends at the walls, and in what is in the way. A fluid whose own surface "
             "is shown too flows once.",
         .inputs =
             {InputSpec{
                  .name = "particles", .type = Type::particles, .value = {}, .doc = "Those of an sph_fluid."},
              amount("amount", 50, "1/s",
                     "How many particles each one of the fluid gives off a second where it is torn."),
              measured(
                  positiveLength("speed", 1,
                                 "How fast water is where it begins to be torn; at three times as much it "
                                 "gives off most. Less of it makes more foam, as suits small tanks."),
                  "m/s"),
              measured(
                  positiveLength("lifetime", 3,
                                 "How long a particle is foam on the fluid, on average; spray and bubbles "
                                 "do not age."),
                  "s"),
              choice("kinds", {std::begin(kFoamKinds), std::end(kFoamKinds)},
                     "Which of them there are: spray, foam or bubbles alone are those of all, so that three "
                     "nodes can show each in another way."),
              integer(
                  "most", 50'000, 1, 4'000'000,
                  "Particles at a time, of all kinds, at most; they take the memory of so many however few "
                  "there are."),
              seed},
         .outputs = {{"particles", Type::particles}},
         .lower = lowerFoam,
         .aliases = {"spray", "bubbles", "whitewater"}},
        {.id = "particles_to_field",
         .label = "Particles to field",
         .category = Category::particles,
         .doc =
             "Makes a solid of particles, for booleans and everything else that works on surfaces. Its "
             "samples are on a grid; where their cells are wider than half a drop's radius, drops look like "
             "boxes.",
         .inputs =
             {positionInput(), particles,
              choice(
                  "surface", {std::begin(kParticleSurfaceNames), std::end(kParticleSurfaceNames)},
                  "Where it is. Blobs: where the density, the sum of (1 - r²/R²)³ over all particles, "
                  "exceeds "
                  "a threshold; fluids are larger than they should be, and bumpy. Average: about the mean "
                  "places of particles; flat where a fluid is, with drops around. Anisotropic: a density of "
                  "particles that are flattened as their neighbours lie, for thin sheets and sharp edges; it "
                  "takes longest."),
              length("drop", 0.0,
                     "The radius of a particle alone, where the surface is average or anisotropic. 0: of a "
                     "fluid, what gives it its volume at rest, 0.62 of its spacing; of its foam half of "
                     "that; of other particles, that of their blob."),
              positiveLength("radius", 0.15, "R: how far a blob's density reaches."),
              [] {
                  InputSpec threshold =
                      scalar("threshold", 0.3,
                             "The density at the surface of blobs. A particle alone has 1 in its "
                             "middle, and is not seen above that.");
                  threshold.positive = true;
                  threshold.max = 100;
                  return threshold;
              }(),
              choice(
                  "method", {std::begin(kDensityMethodNames), std::end(kDensityMethodNames)},
                  "How densities of blobs are added up. Blur is fast and some per cent off, but where dozens "
                  "crowd "
                  "within a radius its solids come out a fifth too large, and like boxes; exact asks every "
                  "particle; proxies asks cells for the mean of theirs."),
              choice(
                  "distance", {"near", "true"},
                  "Where values are distances: near the surface, which is fast; or everywhere in the grid, "
                  "for offsets, shells and blends that reach far: beyond it they are rough."),
              length("margin", 0.0,
                     "How much farther the grid reaches, to every side: room for true distances."),
              integer("resolution", 0, 0, kMostParticleResolution,
                      "Cells along the grid's longest side; 0: 96 of blobs, and of other surfaces as many as "
                      "make them half a drop's radius, or as fit into " +
                          std::to_string(kMostChosenMebibytes) +
                          " MiB. A blob's radius is best two to six cells, and is eight at most in a grid "
                          "that is found."),
              grippedCorner(corner("region_min",
                                   "Lowest corner of the grid; found from where the particles come from, at "
                                   "all times of the "
                                   "timeline, if not given."),
                            "region_max"),
              grippedCorner(corner("region_max", "Highest corner of the grid. What leaves it is cut off."),
                            "region_min")},
         .outputs = {{"surface", Type::surface}},
         .lower = lowerParticlesToField,
         .aliases = {"metaballs", "blobs"}},
    };
}

}  // namespace fw
