// The solid as it was meshed, cut at the region, and the ground. After view.glsl and places.glsl; `frame` is the RenderFrame.

// In w the distance to the region, negative inside; xyz points to its nearest side.
vec4 regionDistance(vec3 p) {
    vec3 q = max(frame.lo - p, p - frame.hi);
    float inner = max(q.x, max(q.y, q.z));
    vec3 side = sign(p - 0.5 * (frame.lo + frame.hi)) * vec3(equal(q, vec3(inner)));
    return vec4(side, length(max(q, 0.0)) + min(inner, 0.0));
}

// Whether rays of ambient occlusion from within `margin` of p can reach the solid.
bool nearSolid(vec3 p, float margin) {
    vec3 q = max(max(frame.lo - p, p - frame.hi), 0.0);
    float reach = frame.ambientRadius + margin;
    return dot(q, q) < reach * reach;
}

// How far along this ray of the view (rayOf) the ground is; 0 if it is not seen.
float groundAlong(View view, vec3 ray) {
    float along = (frame.ground - view.eye.y) / min(ray.y, -1e-6);
    vec3 p = view.eye + ray * along;
    return ray.y < 0.0 && distance(p.xz, frame.centre.xz) < frame.groundEnd * frame.radius ? along : 0.0;
}

// How much there is of the ground at p: in the distance it fades into what is behind it.
float groundLeft(vec3 p) {
    float away = length(p.xz - frame.centre.xz) / frame.radius;
    return away < frame.groundEnd ? 1.0 - smoothstep(0.43 * frame.groundEnd, frame.groundEnd, away) : 0.0;
}

#ifdef FIELD_PRUNED
// Of places.glsl.
vec3 fromMiddle(vec3 p) { return (p - 0.5 * (frame.lo + frame.hi)) * 2.0 / (frame.hi - frame.lo); }
#endif

#ifdef FIELD_VALUE
// What the marching of a ray asks for at each step. Read once before the loop: no compiler moves loads of uniforms out of it.
struct Bounds {
    vec3 centre, half_, perHalf;
    vec3 stepLo, stepHi;  // corners of the box in which stepScale holds
    float stepScale, ground;
};
Bounds solidBounds() {
    vec3 centre = 0.5 * (frame.lo + frame.hi), half_ = 0.5 * (frame.hi - frame.lo);
    bvec3 local = bvec3(frame.localSteps != 0);
    vec3 stepLo = mix(vec3(-1e30), frame.lo, local), stepHi = mix(vec3(1e30), frame.hi, local);
    return Bounds(centre, half_, 1.0 / half_, stepLo, stepHi, frame.stepScale, frame.ground);
}

// The position at which the field bounds the distance from p to the solid: p itself or, if the Lipschitz constant only holds
// within the region, the point of the region that is nearest to p. No point of the region is closer to p than to that point.
vec3 steppingPoint(Bounds bounds, vec3 p) { return clamp(p, bounds.stepLo, bounds.stepHi); }

// A distance that a ray may safely go, to the solid or the ground; inside the solid negative.
float clearance(Bounds bounds, vec3 p) {
    vec3 q = abs(p - bounds.centre) - bounds.half_;
    vec3 within = steppingPoint(bounds, p), at = (within - bounds.centre) * bounds.perHalf;
    chooseMembers(at);
    float region = max(q.x, max(q.y, q.z)), solid = max(fieldValue(within) * bounds.stepScale, region);
    return min(withinPlaces(at) ? solid : region, p.y - bounds.ground);
}
#endif
