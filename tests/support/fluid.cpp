#include "tests/support/fluid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <map>

#include "tests/support/gpu.h"

namespace fw::test {

namespace {

std::map<std::string, FluidKernels> kernelsByObstacle;  // by the obstacle's text, of all tests

}  // namespace

void Fluid::TearDownTestSuite() { kernelsByObstacle.clear(); }

const FluidKernels& kernelsFor(const std::string& obstacle) {
    const auto found = kernelsByObstacle.find(obstacle);
    return found != kernelsByObstacle.end()
               ? found->second
               : kernelsByObstacle.emplace(obstacle, createFluidKernels(device(), obstacle)).first->second;
}

std::vector<glm::vec3> read(const Buffer& buffer, uint32_t count) {
    std::vector<glm::vec3> list;
    for (const glm::vec4& each : download<glm::vec4>(device(), buffer, count)) list.emplace_back(each);
    return list;
}

void run(FluidParticles& fluid, const FluidConfig& config, int steps, float step,
         const std::string& obstacle) {
    for (int done_ = 0; done_ < steps;) {
        Commands commands(device());
        for (int i = 0; i < 20 && done_ < steps; ++i, ++done_) {
            const Done recorded = recordFluidStep(commands, kernelsFor(obstacle), fluid, config, step);
            ASSERT_TRUE(recorded) << recorded.error().message;
        }
        submit(commands);
    }
}

glm::dvec3 mean(const std::vector<glm::vec3>& list) {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& each : list) sum += each;
    return sum / double(list.size());
}

double meanError(const std::vector<glm::vec3>& places, const FluidConfig& config) {
    const double support = kFluidSupport * config.spacing, weight = fluidLattice().weight;
    const auto beyond = [&](double d) {  // the integral of Wendland's C2 kernel beyond a plane
        const double u = std::clamp(1.0 - d / support, 0.0, 1.0);
        return std::pow(u, 6.0) * (3.5 + u * (1.5 * u - 4.5));
    };
    double sum = 0.0;
    for (const glm::dvec3 p : places) {
        double density = 0.0;
        for (const glm::dvec3 q : places) {
            const double u = std::max(1.0 - glm::distance(p, q) / support, 0.0);
            density += weight * u * u * u * u * (5.0 - 4.0 * u);
        }
        for (int axis = 0; axis < 3; ++axis)
            density += beyond(p[axis] - config.lo[axis]) + beyond(config.hi[axis] - p[axis]);
        sum += std::max(density - 1.0, 0.0);
    }
    return sum / double(places.size());
}

double energyOf(const FluidParticles& fluid, const FluidConfig& config) {
    const std::vector<glm::vec3> places = read(fluid.places, fluid.count),
                                 velocities = read(fluid.velocities, fluid.count);
    double sum = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i)
        sum += 0.5 * glm::dot(velocities[i], velocities[i]) - glm::dot(config.gravity, places[i] - config.lo);
    return sum / double(places.size());
}

}  // namespace fw::test
