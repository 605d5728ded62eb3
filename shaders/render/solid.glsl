// The field as it was meshed: cut at the region. After field.glsl; `frame` is the RenderFrame.

// In w the distance to the region, negative inside; xyz points to its nearest side.
vec4 regionDistance(vec3 p) {
    vec3 q = max(frame.lo - p, p - frame.hi);
    float inner = max(q.x, max(q.y, q.z));
    vec3 side = sign(p - 0.5 * (frame.lo + frame.hi)) * vec3(equal(q, vec3(inner)));
    return vec4(side, length(max(q, 0.0)) + min(inner, 0.0));
}

#ifdef FIELD_VALUE
// A distance that a ray may safely go, to the solid or the ground; inside the solid negative.
float clearance(vec3 p) {
    vec3 q = max(frame.lo - p, p - frame.hi);
    float solid = max(fieldValue(p) * frame.stepScale, max(q.x, max(q.y, q.z)));
    return min(solid, p.y - frame.ground);
}
#endif
