// The solid as rays of light meet it: the whole, and its opaque part. After solid.glsl, with FIELD_VALUE, FIELD_MATERIAL and
// FIELD_OPAQUE.
// Within, a ray goes until it leaves the whole or meets the opaque part. Where transmissive solids overlap, a place is of the
// one that it is deeper in; the interface is where that changes.

const float kSameMedium = 0.01;  // difference in the index of refraction

// The whole solid at p, cut at the region; negative inside.
float wholeAt(Bounds bounds, vec3 p) {
    vec3 q = abs(p - bounds.centre) - bounds.half_;
    vec3 within = steppingPoint(bounds, p), at = (within - bounds.centre) * bounds.perHalf;
    chooseMembers(at);
    float region = max(q.x, max(q.y, q.z));
    return withinPlaces(at) ? max(fieldValue(within) * bounds.stepScale, region) : region;
}
float opaqueAt(Bounds bounds, vec3 p) {
#ifdef FIELD_TRANSMITS
    vec3 q = abs(p - bounds.centre) - bounds.half_;
    return max(fieldOpaque(steppingPoint(bounds, p)) * bounds.stepScale, max(q.x, max(q.y, q.z)));
#else
    return wholeAt(bounds, p);
#endif
}

// What a ray asks for at each step. Of an opaque solid it need not know the region's sides on the way: one that begins at them
// within the solid hits there.
float stepAt(Bounds bounds, vec3 p) {
#if defined(FIELD_TRANSMITS) || defined(FIELD_FAMILIES)
    return wholeAt(bounds, p);
#else
    return fieldValue(p) * bounds.stepScale;
#endif
}

// Where a ray is, and how it came there.
struct Way {
    float t;
    bool hit;      // a surface, or an interface between two media
    bool opaque;   // the surface, is it
    bool between;  // it is an interface
    bool changes;  // it is neither: the medium changed slowly; the ray goes on from there
    vec3 optical;  // exp(-optical) of the light is left
    float ior;     // of what it came through in the end
    vec3 absorption;
    uint steps;
};

// From o along d, not farther than `end`; `within` a medium, or outside. What is nearer than `close` is hit, or than a part of
// the way gone, so that rays may leave the surface they start on.
Way follow(Bounds bounds, vec3 o, vec3 d, float start, float end, bool within, float ior, vec3 absorption, float close, uint most) {
    const float kLeave = 0.25;
#ifndef FIELD_TRANSMITS
    within = false;  // so that drivers see it
#endif
    Way way = Way(start, false, !within, false, false, vec3(0.0), ior, absorption, 0);
    float free = start, f = 0.0;
    if (start < end) {
        do {
            vec3 p = o + d * way.t;
            float whole = stepAt(bounds, p);
            f = whole;
#ifdef FIELD_TRANSMITS
            float opaque = opaqueAt(bounds, p);
            way.opaque = within ? opaque < -whole : opaque < whole + 2.0 * close;
            f = within ? min(-whole, opaque) : whole;
#ifdef FIELD_MEDIA
            if (within && f > close) {
                FieldMaterial medium = fieldMaterial(p);
                way.changes = abs(medium.ior - ior) > kSameMedium;
                if (way.changes) break;
                way.optical += way.absorption * (way.t - free);
                way.absorption = medium.absorption;
                free = way.t;
            }
#endif
#endif
            float least = min(close, kLeave * way.t + 0.01 * close);
            bool jumped = f < -least && way.t - free > least && !within;
            way.hit = f < least && !jumped;
            float onward = jumped ? 0.5 * (free + way.t) : way.t + max(f, 0.02 * close);
            free = jumped || within ? free : way.t;
            way.t = way.hit ? way.t : onward;
        } while (!way.hit && way.t < end && ++way.steps < most);
    }
#ifdef FIELD_MEDIA
    if (way.changes) {
        // Another medium, or the same that changes slowly, which light would not notice.
        float before = free, behind = way.t, there = fieldMaterial(o + d * way.t).ior;
        for (int k = 0; k < 24; ++k) {
            float middle = 0.5 * (before + behind), here = fieldMaterial(o + d * middle).ior;
            bool same = abs(here - ior) < abs(here - there);
            before = same ? middle : before;
            behind = same ? behind : middle;
        }
        way.between = abs(fieldMaterial(o + d * behind).ior - fieldMaterial(o + d * before).ior) > kSameMedium;
        way.hit = way.between;
        way.opaque = false;
        way.t = way.between ? behind : way.t;
        way.ior = way.between ? ior : there;
        way.changes = !way.between;
    }
    way.optical += within ? way.absorption * max(min(way.t, end) - free, 0.0) : vec3(0.0);
#else
    way.optical = within ? absorption * min(way.t, end) : vec3(0.0);
#endif
    // One that ran out of steps beside a surface grazes it.
    way.hit = way.hit || (way.steps == most && f < max(16.0 * close, 0.05 * way.t) && !way.changes);
    return way;
}
