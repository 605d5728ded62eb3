#include "runtime/stages/carried_points.h"

namespace fw {

NearestWeights nearestWeights(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b,
                              const glm::dvec3& c) {
    // By the regions of corners, sides and face (Ericson, Real-Time Collision Detection, 5.1.5).
    const glm::dvec3 ab = b - a, ac = c - a;
    const auto at = [&](double second, double third) {
        const glm::dvec3 off = point - a - second * ab - third * ac;
        return NearestWeights{glm::dot(off, off), {1.0 - second - third, second, third}};
    };
    const glm::dvec3 fromA = point - a, fromB = point - b, fromC = point - c;
    const double abA = glm::dot(ab, fromA), acA = glm::dot(ac, fromA);
    if (abA <= 0.0 && acA <= 0.0) return at(0.0, 0.0);
    const double abB = glm::dot(ab, fromB), acB = glm::dot(ac, fromB);
    if (abB >= 0.0 && acB <= abB) return at(1.0, 0.0);
    const double abC = glm::dot(ab, fromC), acC = glm::dot(ac, fromC);
    if (acC >= 0.0 && abC <= acC) return at(0.0, 1.0);
    const double overAb = abA * acB - abB * acA, overAc = abC * acA - abA * acC,
                 overBc = abB * acC - abC * acB;
    if (overAb <= 0.0 && abA >= 0.0 && abB <= 0.0) return at(abA / (abA - abB), 0.0);
    if (overAc <= 0.0 && acA >= 0.0 && acC <= 0.0) return at(0.0, acA / (acA - acC));
    if (overBc <= 0.0 && acB >= abB && abC >= acC) {
        const double share = (acB - abB) / ((acB - abB) + (abC - acC));
        return at(1.0 - share, share);
    }
    const double sum = overAb + overAc + overBc;
    if (!(sum > 0.0)) return at(0.0, 0.0);
    return at(overAc / sum, overAb / sum);
}

}  // namespace fw
