// What the kernels of runtime/particles/foam.h share with C++. After shared.h.
#ifndef FW_FOAM_H
#define FW_FOAM_H
#ifdef __cplusplus
namespace fw::gpu {
#endif

// Kinds, in the order of the node's choices behind "all".
#define FOAM_SPRAY 0
#define FOAM_FOAM 1
#define FOAM_BUBBLE 2

struct FoamNumbers {
    uint slots;
    uint step, seed;  // what chances follow from
    float amount;     // a step and torn particle
    float speed;      // m/s: at which water begins to be torn
    float lifetime;   // s
    int shown;        // the kind
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
