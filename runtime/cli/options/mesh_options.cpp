// Of the commands that write meshes.
#include "runtime/cli/options/groups.h"
#include "runtime/cli/options/options.h"
#include "runtime/cli/options/words.h"
#include "runtime/cli/sequence.h"
#include "runtime/export/export.h"
#include "runtime/export/points.h"

namespace fw::cli {

CLI::App* addExport(CLI::App& program, ExportOptions& options) {
    CLI::App* command = program.add_subcommand(
        "export",
        "Turn a graph into a mesh file, with --from, --to or --fps into one for every frame; "
        "or its particles into points");
    addMesh(command, options.mesh);
    std::string endings;
    for (const ExportFormat& format : exportFormats())
        endings += (endings.empty() ? "" : " ") + std::string(format.ending);
    std::string pointEndings;
    for (const char* ending : kPointEndings)
        pointEndings += (pointEndings.empty() ? "" : " ") + std::string(ending);
    command
        ->add_option("-o,--output", options.output,
                     "The mesh file; its ending says the format: " + endings + "; of particles: " +
                         pointEndings + "; of a sequence or a sweep the folder, for 000000.glb and so on")
        ->required();
    command->add_flag("--manifold", options.manifold,
                      "Mark the mesh of a .glb or .gltf as a solid (EXT_mesh_manifold), for programs "
                      "that compute with solids; an error if it is none");
    command->add_flag("--compress", options.compress,
                      "Of a .glb or .gltf: few bits a number and meshoptimizer's code "
                      "(KHR_mesh_quantization, EXT_meshopt_compression), a sixth of the size; three.js, "
                      "Babylon and game engines read it");
    command->add_flag("--split-materials", options.splitMaterials,
                      "Cut the faces of a .glb, .gltf or .obj where the materials of two nodes meet, so "
                      "that each is of one");
    CLI::Option* textures =
        command->add_option("--textures", options.textures,
                            "Unwrap the mesh of a .glb, .gltf or .obj, and bake its colours, finish, "
                            "light, occlusion and normals "
                            "from the field into textures of so many texels a side: 64, 128, ... 8192");
    textures->type_name("TEXELS")->check(something());
    CLI::Option* lods =
        command
            ->add_option(
                "--lods", options.lods,
                "Levels of detail in a .glb or .gltf, each with a quarter of the triangles of the one "
                "before, as nodes whose names end in _LOD0 and so on; they share materials and textures")
            ->check(whole(1, kMostLevels));
    command->add_flag("--parts", options.parts,
                      "Of a .glb or .gltf: what touches nowhere is a node of its own");
    CLI::Option* instances =
        command
            ->add_option("--instances", options.instances,
                         "Of a .glb or .gltf: copies that stand apart, as repeat, scatter and polar_repeat "
                         "make them, share one mesh; as nodes, which every program reads, or gpu "
                         "(EXT_mesh_gpu_instancing), smaller, for game engines, three.js and Babylon")
            ->type_name("[FORM]")
            ->expected(0, 1)
            ->default_str("nodes")
            ->check(oneOf({"nodes", "gpu"}));
    std::vector<std::string> units;
    for (const LengthUnit& unit : lengthUnits()) units.emplace_back(unit.name);
    command
        ->add_option(
            "--unit", options.placement.unit,
            "Of lengths in a .stl, .obj, .ply or .vdb (default: the document's, of which glTF and 3MF "
            "are scaled to theirs, metres and millimetres)")
        ->check(oneOf(units));
    command->add_option("--up", options.placement.up, "The axis that points up in the file (default: y)")
        ->check(oneOf({"y", "z"}));
    command
        ->add_option("--for", options.placement.purpose,
                     "print: millimetres and +Z up, as slicers have it; of a .stl or .3mf")
        ->check(oneOf({"print"}))
        ->excludes("--unit")
        ->excludes("--up");
    CLI::Option* particles =
        command
            ->add_option(
                "--particles", options.particles,
                "Write the particles that this node of the document itself gives at the time, or at every "
                "frame, in place of a mesh: their places, velocities and numbers, as points that a "
                "particle_file reads; NODE.OUTPUT of a group that has several outputs")
            ->type_name("NODE")
            ->check(something());
    addMeasures(command, options);
    addOpenJd(command);
    addSequence(command, options.sequence);
    addPart(command, options.sequence);
    command->parse_complete_callback([command] { oneMomentOrMany(command); });
    std::vector<std::string> formats;
    for (const ExportFormat& format : exportFormats()) formats.emplace_back(format.ending + 1);
    for (const char* ending : kPointEndings)
        if (!exportFormat(std::string("a") + ending)) formats.emplace_back(ending + 1);
    command
        ->add_option(
            "--format", options.format,
            "Of a sequence or a sweep: what each of its meshes is (default: glb), or its particles (ply)")
        ->check(oneOf(formats));
    CLI::Option* animated = command->add_flag(
        "--animated", options.animated,
        "Write all frames into one .glb or .gltf (default: of the whole timeline); or, where the mesh keeps "
        "its triangles, as an .obj and the places of its points, .pc2 or .mdd");
    for (const char* ofOne : {"--time", "--overwrite", "--format", "--frames"})
        animated->excludes(command->get_option(ofOne));
    CLI::Option* sweep =
        command
            ->add_option(
                "--sweep", options.sweep,
                "Write a mesh for every value of a parameter, into a folder: name=from:to:count; of "
                "several every combination; or FILE.csv, whose first line has names and each further "
                "one values")
            ->take_all()
            ->allow_extra_args(false)
            ->check(something());
    for (const char* ofSequences : {"--from", "--to", "--fps", "--range", "--animated"})
        sweep->excludes(command->get_option(ofSequences));
    command
        ->add_option("--triangles", options.mesh.triangles,
                     "Decimate each mesh to at most so many triangles, behind whatever the graph does to it")
        ->check(whole(1, 1 << 24));
    command
        ->add_option("--tiles", options.tiles,
                     "Mesh in tiles, about this many along the longest side, each by itself: memory is "
                     "bounded by a few (default: above 1,024 cells and where the surface is too much at "
                     "once)")
        ->check(whole(1, 64));
    command
        ->add_option(
            "--tile", options.share,
            "Mesh only part i of n of the tiles: i/n. The output is a .part file, for fieldwright merge; a "
            "part that was stopped goes on where it was")
        ->check(something());
    CLI::Option* implicit = command->add_flag("--implicit", options.implicit,
                                              "Write the field itself into the .3mf, as functions "
                                              "(volumetric and implicit extensions) in place of a "
                                              "mesh, +Z up; what they cannot say is named");
    for (const char* ofMeshes : {"--resolution", "--method",    "--manifold",  "--split-materials",
                                 "--compress",   "--parts",     "--unit",      "--up",
                                 "--for",        "--report",    "--require",   "--triangles",
                                 "--tiles",      "--tile",      "--animated",  "--sweep",
                                 "--textures",   "--lods",      "--instances", "--particles",
                                 "--from",       "--to",        "--fps",       "--range",
                                 "--frames",     "--overwrite", "--format"})
        implicit->excludes(command->get_option(ofMeshes));
    for (const char* ofMeshes : {"--resolution", "--region", "--method", "--manifold", "--split-materials",
                                 "--compress", "--parts", "--unit", "--up", "--for", "--report", "--require",
                                 "--triangles", "--tiles", "--tile", "--animated", "--sweep"})
        particles->excludes(command->get_option(ofMeshes));
    for (const char* ofWholes : {"--from", "--to", "--fps", "--range", "--frames", "--overwrite",
                                 "--animated", "--sweep", "--triangles"})
        for (const char* ofOne : {"--tiles", "--tile"})
            command->get_option(ofWholes)->excludes(command->get_option(ofOne));

    for (const char* ofOneMesh :
         {"--from", "--to", "--fps", "--range", "--frames", "--overwrite", "--animated", "--sweep", "--tiles",
          "--tile", "--textures", "--lods", "--manifold", "--parts", "--triangles", "--particles"})
        instances->excludes(command->get_option(ofOneMesh));
    for (const char* without : {"--animated", "--tiles", "--tile", "--particles"})
        lods->excludes(command->get_option(without));
    for (const char* without : {"--split-materials", "--particles"})
        textures->excludes(command->get_option(without));
    return command;
}

CLI::App* addMerge(CLI::App& program, MergeOptions& options) {
    CLI::App* command =
        program.add_subcommand("merge", "Join the parts that export --tile wrote into one mesh file");
    command->add_option("PART", options.parts, "The part files, all of one mesh, in any order")->required();
    command
        ->add_option("-o,--output", options.output,
                     "The mesh file; its ending says the format: .glb .gltf .stl .ply .obj")
        ->required();
    addMeasures(command, options);
    addOpenJd(command);
    return command;
}

}  // namespace fw::cli
