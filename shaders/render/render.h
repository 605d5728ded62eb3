// What the renderer's shaders are told of a frame; C++ includes this file too. After shared.h.
#ifndef FW_RENDER_H
#define FW_RENDER_H

#ifdef __cplusplus
#include <cmath>
#include <glm/common.hpp>

namespace fw::gpu {
using std::log2;
#endif

#define RENDER_TILE 16       // pixels along each side of a tile: one work group of most kernels
#define RENDER_CONE 8        // pixels along each side of a cone of trace.comp
#define RENDER_MOST_RAYS 16  // of ambient occlusion, of a pixel in one frame
#define RENDER_MOST_LIGHTS 16
#define RENDER_MOST_SKIES 12  // levels of an environment map

// Lists of tiles.
#define RENDER_SOLID 0   // that show some of the solid
#define RENDER_GROUND 1  // that do not, but ground on which light may fall unevenly
#define RENDER_BACK 2    // all others
#define RENDER_NEAR 3    // with surface that ambient occlusion may reach
#define RENDER_LISTS 4

#define RENDER_PARALLEL 1     // of TracePush: all rays have one direction
#define RENDER_LOCAL_STEPS 2  // of TracePush: stepScale only holds between lo and hi

#define RENDER_PATHS 8  // pixels along each side of a work group of path.comp

#define RENDER_PLACES 32       // boxes along each axis of the grid of the families' lists: places.glsl
#define RENDER_LEAST_PLACES 4  // of the coarsest; each has twice as many as the one before

#define AMBIENT_HOLES 128  // pixels without history that a work group of ambient_holes.comp does at a time,
#define AMBIENT_LANES 2    // each by so many lanes
#ifndef AMBIENT_MOST_GROUPS
#define AMBIENT_MOST_GROUPS 32768u  // of them; they go on while there are holes
#endif

// What a picture shows: RenderFrame::show.
#define RENDER_PICTURE 0
#define RENDER_AMBIENT 1
#define RENDER_NORMALS 2
#define RENDER_BASE 3
#define RENDER_SHADOW 4
#define RENDER_STEPS 5      // of sphere tracing
#define RENDER_SLICE 6      // the field on an upright plane, with lines of equal distance
#define RENDER_EXACTNESS 7  // there: how far the gradient's length is from 1
#define RENDER_CELLS 8      // of the mesher that hold surface
#define RENDER_THICKNESS 9  // of the solid's walls
#define RENDER_GAP 10       // between its walls
#define RENDER_WIREFRAME 11
#define RENDER_POINTS 12   // particles, in place of their surface
#define RENDER_SPHERES 13  // ditto, each as large as its surface would be were it alone

#define RENDER_MOST_WIDTHS 4.0f  // times RenderFrame::leastWidth: where the scale of the last two ends

// What a wall or a gap is shown in that is so many times as wide as it is to be at least: red below 1,
// yellow, green at 2, blue at RENDER_MOST_WIDTHS and beyond. As a display has it.
#ifdef __cplusplus
inline
#endif
    vec3
    widthColor(float times) {
    if (times < 1.0f) return mix(vec3(0.4f, 0.0f, 0.08f), vec3(0.95f, 0.2f, 0.15f), times);
    float doubled = times < RENDER_MOST_WIDTHS ? log2(times) : 2.0f;
    vec3 yellow = vec3(1.0f, 0.85f, 0.2f), green = vec3(0.25f, 0.75f, 0.35f), blue = vec3(0.25f, 0.45f, 0.9f);
    return doubled < 1.0f ? mix(yellow, green, doubled) : mix(green, blue, doubled - 1.0f);
}

// How a picture is seen. A place in it is (x, y), each from -1 to 1, y upwards. It shows what lies along
// forward + x right + y up; its depth is near / (distance along forward): 1 is near, 0 is nothing at all.
struct View {
    vec3 eye;
    float near;    // metres
    vec3 forward;  // unit length
    float pixel;   // half a pixel's width at a distance of 1
    vec3 right;    // times the tangent of half the angle of view
    vec3 up;
    vec2 jitter;  // of the picture within its pixels, added to places
};

// A light of the scene besides the sun.
struct Light {
    vec3 position;             // metres
    float size;                // radius of the lamp, metres
    vec3 color;                // radiant intensity; of a directional light its irradiance
    float cosOuter, cosInner;  // of a spot's cone; -2 and -1: shines everywhere
    vec3 direction;            // in which the light goes, unit length
    uint directional;          // 1: parallel light, without a position
};

// Of an environment map: texels, rows from the top.
struct SkyLevel {
    uint start;  // the word of the first
    uint width, height;
    float roughness;  // of the mirror that shows it
};

// Everything about one frame, in one uniform block.
struct RenderFrame {
    View now, before;
    uvec2 size;      // of the picture, pixels
    uint tiles;      // that cover it
    uint number;     // of the frame: turns what is random
    uint resting;    // 1: the view is that of the frame before but for the jitter
    vec3 lo;         // the region that was meshed: the solid is cut there
    float cellSize;  // of the mesh, metres
    vec3 hi;
    float stepScale;  // makes the field's value a distance that a ray may safely go
    uint localSteps;  // 1: stepScale only holds between lo and hi
    vec3 centre;      // of the solid
    float radius;     // of the solid, metres
    float ground;     // its height, metres; -1e30: there is none
    float groundEnd;  // how far from the centre the ground fades out, in radii
    float bias;       // of a ray's start off the surface, metres

    float ambientRadius;    // a ray's length, metres
    float ambientStrength;  // 0 to 1
    uint ambientSamples;    // of the field along a ray, at most
    uint raysNew;           // of a pixel without history, up to RENDER_MOST_RAYS
    uint raysKept;          // of one with history
    uint mostKept;          // rays that the history counts for at most
    uint secondaryRays;     // of each kind, of a pixel
    uint balance;  // 1: lanes share the rays of pixels without history; 0: each traces its own pixel's

    vec3 sun;       // towards it, unit length
    vec3 sunLight;  // irradiance on a surface that faces it
    vec3 shadowCentre;
    vec3 shadowRight, shadowUp;  // divided by half the map's width in metres: places from -1 to 1
    vec3 shadowForward;          // the same, away from the sun
    float shadowTexel;           // metres
    uint shadowSize;             // texels along each side; 0: nothing is in shadow
    float sunWide;               // of a traced sun, the tangent of half the angle across it

    vec3 zenith, horizon, groundColor;
    uint studio;     // 1: behind the solid is a wall; 0: the sky
    float exposure;  // factor
    uint neutral;    // 1: Khronos' tone map; 0: ACES
    uint show;
    uint sliceAxis;    // that the plane of the slice stands across; 3: x or z, whichever the view is along
    float sliceAt;     // from the centre, metres
    float leastWidth;  // that walls and gaps are to have, metres
    uint mean;         // frames that the picture is the mean of, before this one

    vec3 fogColor;
    float fogDensity;  // at the ground, 1 / metre
    float fogFalloff;  // with height, 1 / metre
    float fogEnd;      // metres from the eye, where fog ends if nothing is hit
    uint fogKept;      // frames that it is the mean of, at most; 0 where the picture is a mean itself

    float skyScale;  // factor of the environment map, if there is one
    float skyTurn;   // of it, whole turns
    uint skyChances, skyColumns, skyRows;
    uint skyLevels;  // behind them is the one of matt surfaces
    SkyLevel sky[RENDER_MOST_SKIES];

    uint lightCount;
    Light lights[RENDER_MOST_LIGHTS];
};

// Pixels that lack a history of ambient occlusion, and the dispatch over them.
struct AmbientHoles {
    uint holes;
    DispatchArguments arguments;
};

// Successive triangles of the mesh, which its order keeps together: the box about them, and that about their
// normals.
#define CLUSTER_TRIANGLES 64
struct Cluster {
    vec3 lo, hi, normalLo, normalHi;
};

// The clusters that a pass draws: how many, a dispatch of as many groups as there may be, and the draw of
// their triangles.
struct ClusterCounts {
    uint clusters;
    DispatchArguments seen;
    uint draw[5];  // arguments of vkCmdDrawIndexedIndirect
};

struct CullPush {
    vec4 sides[4];  // of what is seen, planes with their inner sides positive
    vec4 eye;       // w 1: where rays begin; w 0: their common direction
    uint clusters;
    uint backs;  // 1: clusters that face away are left out
};

// Particles that are drawn.
struct SpritePush {
    vec4 toClip[4];   // rows of the matrix
    vec4 eye;         // w 1: where rays begin; w 0: their common direction
    vec3 normals[3];  // the products of these with a normal are one in the picture's space, of any length
    float perFast;    // one over the speed at which they are white, seconds per metre
    float radius;     // metres
    float least;      // that of the picture, at a distance of 1 from the eye
};

// What a draft shows the solid in: as FieldMaterial of field.glsl.
struct DraftMaterial {
    vec3 base;  // unless each vertex has its own
    float roughness;
    vec3 emission;
    float metallic;
    uint colored;  // 1: each vertex has its own base colour
};

// Rays of trace.comp: from origin + x originX + y originY along direction + x directionX + y directionY, over
// t.
struct TracePush {
    vec3 origin, originX, originY;
    vec3 direction, directionX, directionY;
    vec3 lo, hi;  // of the region
    float near;   // depth is near / t, or 1 - t near if parallel
    float pixel;  // its size; times t unless parallel
    float close;  // a field below it is a hit, likewise
    float stepScale;
    uvec2 size;
    uint flags;  // RENDER_PARALLEL, RENDER_LOCAL_STEPS
    uint steps;  // of a ray, at most
};

// Paths of light.
struct PathPush {
    uint path;      // which of the pixel's the first is, from 0
    uint paths;     // of each pixel
    uint bounces;   // off opaque surfaces, at most
    float lens;     // its radius, metres; 0: a pinhole
    float focus;    // metres along the view's direction
    vec3 sun;       // towards the middle of its disc
    uint cutout;    // 1: what is behind the solid is left out
    float sunWide;  // how much the cosine of its edge is less than 1; 0: it is a point; -1: there is none
};

struct BloomPush {
    float plain, blurred, smaller;  // weights of the picture, of it blurred, and of the one below it
    float variance;                 // of the blur, texels
};

struct PlacesPush {
    vec3 lo, hi;     // of the region
    uint side;       // boxes along each axis
    uint listStart;  // of the lists: entries before are those of place 0
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
