// Where what is seen now was seen in the frame before. After view.glsl, gbuffer.glsl or octahedral.glsl, and solid.glsl; `frame`
// is the RenderFrame, surfacesBefore the G-buffer of the frame before.

const float kSamePlane = 0.01;  // of the distance to the eye
const float kSameNormal = 0.9;  // cosine

// Whether a pixel of the frame before showed the surface at p: by the distance to its plane, not by depth alone, which would
// lose grazing surfaces.
bool sameBefore(vec3 p, vec3 n, uvec2 was) {
    uvec4 old = imageLoad(surfacesBefore, ivec2(was));
    float depth = uintBitsToFloat(old.x);
    vec3 pOld = pointAt(frame.before, placeOf(was, frame.size), depth > 0.0 ? depth : 1.0);
    return depth > 0.0 && abs(dot(n, pOld - p)) < kSamePlane * distance(p, frame.now.eye) &&
           dot(n, unpackOctahedral(old.y)) > kSameNormal && nearSolid(pOld, 0.0);
}

// Whether the surface at p was seen, and in `was` the pixel: `here` if the view rests.
bool seenBefore(vec3 p, vec3 n, bool rests, uvec2 here, out uvec2 was) {
    vec3 seen = project(frame.before, p);
    vec2 size = vec2(frame.size), place = vec2(0.5 + 0.5 * seen.x, 0.5 - 0.5 * seen.y) * size;
    bool inBefore = rests || (seen.z > 0.0 && all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, size)));
    was = rests ? here : inBefore ? uvec2(place) : uvec2(0);
    return inBefore && sameBefore(p, n, was);
}

#ifdef FIELD_BEFORE
// Where a place on the solid's surface was: its field then is how far the surface has moved along the normal since.
vec3 placeBefore(vec3 p, vec3 n) {
#ifdef FIELD_MOVES
    fieldBeginBefore();
    chooseMembers(fromMiddle(p));
    float moved = fieldValue(p) * frame.stepScale;
    fieldBegin();
    return p - n * clamp(moved, -frame.ambientRadius, frame.ambientRadius);
#else
    return p;
#endif
}
#endif

// The same of what a pixel shows, at p in the frame before: in a view that rests it stays where it is.
bool pixelSeenBefore(vec3 p, vec3 n, uvec2 here, out uvec2 was) { return seenBefore(p, n, unfolded(frame.resting) != 0, here, was); }
