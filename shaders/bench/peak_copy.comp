// Copies 16 bytes an invocation from one storage buffer to another.
layout(binding = 0, scalar) readonly buffer Source { uvec4 source[]; };
layout(binding = 1, scalar) writeonly buffer Target { uvec4 target[]; };

layout(local_size_x = 256) in;

void main() {
    uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 256 + gl_LocalInvocationID.x;
    target[i] = source[i];
}
