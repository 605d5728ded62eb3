// What people call the nodes who come from another program.
#include <algorithm>
#include <utility>

#include "editor/document/library.h"

namespace fw::editor {

namespace {

// Of Blender's modifiers and geometry nodes, Houdini's operators, Substance and Material Maker, OpenSCAD, and
// the functions of hg_sdf and of Quilez' articles.
constexpr std::pair<std::string_view, std::string_view> kNames[] = {
    {"sphere", "uv sphere icosphere fsphere"},
    {"cylinder", "tube fcylinder rod"},
    {"infinite_cylinder", "drill hole bore"},
    {"capsule", "pill fcapsule line rod"},
    {"torus", "ftorus tyre"},
    {"link", "chain"},
    {"cone", "fcone"},
    {"capped_cone", "frustum funnel bucket"},
    {"ellipsoid", "egg"},
    {"cut_sphere", "dome hemisphere bowl"},
    {"box", "fbox block brick"},
    {"box_max", "fboxcheap"},
    {"box_frame", "wireframe cage lattice"},
    {"plane", "ground floor grid fplane"},
    {"slab", "floor plate layer"},
    {"pyramid", "roof"},
    {"prism", "hexagon nut bolt"},
    {"gyroid", "infill tpms lattice"},
    {"schwarz_p", "infill tpms lattice"},
    {"diamond", "infill tpms lattice"},
    {"heightfield", "landscape displacement dem lithophane"},
    {"circle", "disc disk"},
    {"rectangle", "square quad"},
    {"polygon", "curve path outline profile sketch spline"},
    {"regular_polygon", "ngon hexagon pentagon triangle"},
    {"text", "letters font string words type label engrave"},
    {"svg_file", "vector drawing import logo inkscape illustrator"},
    {"dxf_file", "autocad drawing import laser cad"},
    {"gear", "cog wheel tooth involute spur"},
    {"thread", "screw bolt nut metric helix"},
    {"spring", "helix coil wire spiral"},
    {"extrude", "linear_extrude polyextrude solidify thickness"},
    {"revolve", "rotate_extrude spin screw sweep"},
    {"union", "join merge add boolean combine opunion smooth_union smin minimum bevel fillet chamfer"},
    {"intersect", "boolean opintersection common maximum smooth_intersection"},
    {"subtract", "difference boolean cut opdifference minus hole smooth_subtraction"},
    {"xor", "boolean difference exclude"},
    {"morph", "blend mix interpolate blendshape shape_key"},
    {"translate", "position location set_position place"},
    {"rotate", "orient euler pr"},
    {"scale", "size resize uniform"},
    {"stretch", "scale nonuniform squash"},
    {"transform", "xform matrix trs transform_geometry"},
    {"mirror", "symmetry reflect fold pmirror"},
    {"repeat", "instance copy grid domain_repetition pmod pmod1 pmod2 pmod3 fmod tile linear_pattern"},
    {"scatter", "instance distribute points copy_to_points random grass"},
    {"polar_repeat", "instance radial pmodpolar circular_pattern clone"},
    {"twist", "deform simple_deform"},
    {"bend", "deform simple_deform curl"},
    {"taper", "deform simple_deform"},
    {"elongate", "stretch extend pull"},
    {"warp", "deform domain_distortion distort mod attribute_vop"},
    {"offset", "round dilate erode peak shrink fatten minkowski rounding"},
    {"shell", "solidify thickness wall oponion"},
    {"displace", "bump mountain relief displacement"},
    {"position", "coordinates point p texture_coordinate"},
    {"time", "frame scene_time clock"},
    {"value", "number float constant"},
    {"vector", "vec3 constant"},
    {"color", "rgb swatch constant"},
    {"parameter", "slider control exposed spare group_input"},
    {"noise", "perlin simplex fbm fractal turbulence voronoi worley clouds musgrave"},
    {"hash", "random white_noise"},
    {"distance", "sdf sample proximity"},
    {"from_distance", "implicit threshold levelset isosurface"},
    {"math", "add subtract multiply divide power sine minimum maximum clamp abs"},
    {"vector_math", "dot cross normalize length add"},
    {"combine_xyz", "make vector merge"},
    {"separate_xyz", "break vector split"},
    {"map_range", "fit remap rescale"},
    {"color_ramp", "colorramp gradient colour_map gradient_map palette"},
    {"curve", "float_curve rgb_curves ramp_parameter spline remap levels"},
    {"mix", "blend interpolate fade"},
    {"expression", "script wrangle vex glsl formula custom"},
    {"material", "shader principled bsdf color colour paint glass metal roughness"},
    {"triplanar", "box_mapping project"},
    {"mesh_file", "load obj stl gltf glb ply off read"},
    {"mesh_to_field", "vdb from polygons remesh sdf volume"},
    {"polygonize", "remesh marching cubes dual contouring convert mesh triangulate"},
    {"smooth", "relax laplacian"},
    {"subdivide", "subdivision surface catmull loop"},
    {"decimate", "polyreduce reduce simplify lod remesh"},
    {"output", "result render out"},
    {"reroute", "dot null relay"},
    {"frame", "comment note backdrop sticky network_box"},
    {"group", "subnet subgraph digital_asset hda macro"},
    {"emitter", "popnet source sparks"},
    {"particle_file", "points csv xyz bgeo ply"},
    {"particle_dynamics", "pop solver gravity simulate"},
    {"sph_fluid", "flip simulate splash"},
    {"foam", "splash droplets"},
    {"particles_to_field", "vdb from particles particle_fluid_surface"},
};

}  // namespace

std::string_view otherNames(std::string_view type) {
    const auto found = std::ranges::find(kNames, type, &std::pair<std::string_view, std::string_view>::first);
    return found == std::end(kNames) ? std::string_view() : found->second;
}

}  // namespace fw::editor
