// Links: eight words a brick. Word x | y << 1 | z << 2 is the slot of the brick one further along those axes (0: its own; its own,
// too, where there is none); word 7 has a bit for each face beyond which there is a brick: +x, +y, +z, -x, -y, -z.
layout(binding = MESHER_AT_LINKS, scalar) buffer Links { uint links[]; };
