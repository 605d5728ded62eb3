// What the kernel of runtime/window/window.h shares with C++. After shared.h.
#ifndef FW_WINDOW_H
#define FW_WINDOW_H
#ifdef __cplusplus
namespace fw::gpu {
#endif

#define WINDOW_GROUP 8  // pixels along each side of a work group

struct WindowPush {
    uvec2 picture, window;  // sizes in pixels
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
