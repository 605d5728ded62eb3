// Quadric error (Garland and Heckbert 1997): the weighted sum of squared distances from planes, at any point.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace fw {

struct Quadric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  ///< of the symmetric matrix
    glm::dvec3 linear{0.0};
    double constant = 0;

    /// Of unit normal `normal`, through `point`.
    void addPlane(const glm::dvec3& normal, const glm::dvec3& point, double weight) {
        const glm::dvec3 n = weight * normal;
        const double d = -glm::dot(normal, point);
        xx += n.x * normal.x;
        xy += n.x * normal.y;
        xz += n.x * normal.z;
        yy += n.y * normal.y;
        yz += n.y * normal.z;
        zz += n.z * normal.z;
        linear += d * n;
        constant += weight * d * d;
    }
    void add(const Quadric& other) {
        xx += other.xx;
        xy += other.xy;
        xz += other.xz;
        yy += other.yy;
        yz += other.yz;
        zz += other.zz;
        linear += other.linear;
        constant += other.constant;
    }
    /// Not negative but for rounding.
    double at(const glm::dvec3& p) const {
        const glm::dvec3 product(xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z,
                                 xz * p.x + yz * p.y + zz * p.z);
        return glm::dot(p, product + 2.0 * linear) + constant;
    }
};

}  // namespace fw
