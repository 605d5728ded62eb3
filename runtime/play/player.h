// A saved graph, played: what a program embeds that wants the mesh or the picture of a graph at a time.
//
//     fw::Result<fw::Player> player = fw::Player::open("cube.field.json");
//     if (!player) return std::puts(format(player.error()).c_str()), 1;
//     if (!player->set("roundness", 0.2)) std::puts("the graph has no roundness");
//     for (int frame = 0; frame < 60; ++frame) {
//         player->advance(1.0 / 60);
//         const fw::Result<fw::Mesh> mesh = player->mesh();
//         …
//     }
//
// What the timeline moves, what the graph exposes and the time itself are live parameters of the compiled
// program: a seek evaluates the tracks and uploads their values, and never compiles. The mesh is made when it
// is asked for, and again only once a value that the field reads has changed.
//
// All times of the timeline share one region, so that the grid does not swim under a moving solid: bounds are
// found at its keys and at even steps between. A frame whose solid leaves it, or may do so, gets a region of
// its own. So a frame depends on its time and on the parameters alone, not on those that came before it.
//
// Particles have a past: what they are at a time comes from the steps up to then, of which some are kept for
// seeking back. A parameter that is set while they fly bears on what is to come, and on all once they are
// played from the start again.
//
// Lifetime: a Player owns its device; a mesh or picture that it returned is the caller's. It is not safe to
// call from several threads at once. A failure of the device or the system is thrown as SystemError; every
// other is a returned Error, after which the player is as it was before. After a DeviceLost, renewDevice()
// has it go on.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "graph/compile/live_program.h"
#include "runtime/bake/mesh_field_baker.h"
#include "runtime/play/session.h"

namespace fw {

struct PlayerOptions {
    std::string device = {};                ///< index or part of the name of the device; empty: chosen
    std::optional<Box> region = {};         ///< metres; none: found
    int resolution = 0;                     ///< cells along the region's longest side; 0: the graph's
    std::optional<MeshMethod> method = {};  ///< none: the graph's
    int triangles = 0;                      ///< as CompileOptions has it, and so with
    bool byShape = false;
    bool liveParameters = true;       ///< set() uploads; otherwise it compiles, and the field is faster
    std::set<std::string> live = {};  ///< further inputs, "node.input", that reload() uploads
    /// Nothing waits for kernels to be compiled: until they are there, meshes are made on the host and
    /// pictures are drafts (Session::replaceProgram).
    bool compileBehind = false;
    FieldBy fieldBy = FieldBy::sooner;  ///< of the player's creation, as its device
    bool checked = false;  ///< check() was called: only what the output needs must be free of errors
    uint32_t view = RENDER_PICTURE;  ///< that pictures will be of
    /// Called while a mesh is made a field, with what is done of it: from 0 to 1. That of a player's creation
    /// stays; reload() takes no other.
    std::function<void(double share)> baking = {};
    /// Called while particles are simulated, with the steps that are done and those there are; false ends it.
    std::function<bool(int done, int all)> simulating = {};
    /// Gives the token that ends the present search for the solid; the error is then cancelledError().
    std::function<std::stop_token()> stop = {};
    DeviceOptions deviceOptions = {};  ///< further wishes, for a device that presents
};

/// A parameter that set() takes.
struct PlayerParameter {
    std::string name;
    std::vector<double> value;  ///< 1 to 3 numbers
    double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
    bool animated = false;  ///< the timeline moves it: set() has no lasting effect
};

inline constexpr int kMostMoments = 16;

class Player {
  public:
    /// Reads, checks and compiles the graph and opens a device. `warnings`, which may be null, gets what
    /// check() has to say beside errors. Errors: the first of the file, of check() and of the region; no such
    /// device.
    static Result<Player> open(const std::string& path, const PlayerOptions& options = {},
                               std::vector<Error>* warnings = nullptr);
    /// The same with a document that was read, on a device that is given.
    /// The device is taken only if that succeeds.
    static Result<Player> create(Graph graph, Device&& device, const PlayerOptions& options = {});

    const Graph& graph() const { return now.graph; }
    const Timeline& timeline() const { return now.timeline; }
    /// What is played was read from these: the graph's file, if it has one, and the pictures it shows.
    std::vector<std::string> files() const;
    /// Whether anything moves: the timeline has tracks, or the field reads the time.
    bool moves() const { return now.fieldMoves || !now.timeline.tracks.empty(); }

    std::vector<PlayerParameter> parameters() const;
    /// Changes a parameter until the next set() or reload. Errors: no such parameter (with the nearest name),
    /// a value out of its range, another number of numbers.
    Done set(std::string_view name, std::span<const double> value);
    Done set(std::string_view name, double value) { return set(name, std::span(&value, 1)); }

    /// Seconds since the start, as last sought; and where on the timeline that is.
    double time() const { return seconds; }
    double timelineTime() const { return fw::timelineTime(now.timeline, seconds); }
    void seek(double to);
    void advance(double by) { seek(seconds + by); }

    /// The mesh now, copied to the host; without triangles where the solid is empty. Errors as
    /// Session::polygonise. With `parts`, where the material varies, each part has its own (partByMaterial).
    Result<Mesh> mesh(MaterialParts parts = MaterialParts::none);
    /// The same and coarser levels of it: Session::downloadLevels().
    Result<std::vector<Mesh>> levels(std::size_t count, MaterialParts parts = MaterialParts::none);
    /// The same where the mesher left it on the device: in deviceMesh(), until the next call of anything.
    /// That of a picture that showsParticles() lacks their surfaces.
    Result<MesherResult> meshOnDevice(uint32_t show = RENDER_PICTURE);
    /// What the mesh is made in: the region, of all times unless a parameter was set since it was last made;
    /// whether it was found rather than given; and the cells along its longest side.
    Box region() const { return now.region.value_or(Box{}); }
    bool regionFound() const { return now.regionFound; }
    /// The region of the last mesh. It is larger than region() where the solid left that one.
    Box meshedRegion() const { return lastRegion; }
    int resolution() const;
    /// The next meshes have at most so many cells along it, in the same region; 0: as many as were asked for.
    void coarsen(int cells);
    /// Whether the next mesh will be made on the host.
    bool meshesOnHost() { return session.meshesOnHost(); }
    /// What to say of a mesh that has fewer cells than it should, since the device has no room for those:
    /// half of them, or a quarter.
    std::optional<Error> coarser() const;
    const MesherBuffers& deviceMesh() const { return session.meshBuffers(); }

    /// Whether the last mesh was closed where its surface leaves the region.
    bool capped() const { return lastCapped; }

    /// A picture of what the graph shows now, through the document's scene unless `options` bring a camera.
    /// Where the camera has a shutter and something moves it is the mean of up to kMostMoments moments while
    /// the shutter is open, which is from now on.
    /// Errors as Session::render, of the scene, and of an empty solid.
    Result<Picture> frame(const RenderOptions& options = {});

    /// The live view's next frame, into `picture`, which goes on from the last one; false if it would be the
    /// same or was cancelled (runtime/render/renderer.h). Errors as frame().
    Result<bool> show(const RenderOptions& wishes, Picture& picture) { return showTo(wishes, &picture); }
    /// The same, left on the device for a window: picture(), none before the first.
    Result<bool> show(const RenderOptions& wishes) { return showTo(wishes, nullptr); }
    const Image* picture() const { return session.picture(); }
    /// Such a frame of the mesh alone, beside the live view, which does not know of it: Session::sketch().
    Result<bool> sketch(const RenderOptions& wishes, Picture& picture);
    /// Another number if the mesh that was made last, or its field, differ from what they were at another.
    uint64_t contentNumber() const { return session.contentNumber(); }

    /// What the scene's sky is a picture of, if it is.
    const EnvironmentMapPtr& environment() const { return now.environment; }
    /// The scene now. Errors as readScene.
    Result<Scene> scene() const;
    /// Through what camera a picture without one of its own is seen now: the scene's, else one that frames
    /// the outline, in a picture so many times as wide as high; none of an empty solid. Errors as scene() and
    /// outline().
    Result<std::optional<Camera>> camera(float aspect);
    /// Points of the solid's surface at even steps through the timeline: what a picture without a camera
    /// frames, so that it rests while the solid moves. Errors as Session::polygonise.
    Result<std::span<const gpu::MeshVertex>> outline();

    /// Plays another state of the document, at the same time, with the parameters that were set and still
    /// fit. If it cannot be played, the Error says why and the player goes on with what it has.
    Done reload(Graph graph);
    /// The same with other options; the device stays. If only values of live inputs differ, that is an
    /// upload.
    Done reload(Graph graph, const PlayerOptions& changed);

    /// Opens a device in place of the one that was lost, for the same document, time and parameters. All that
    /// was made from device() dies before. Throws SystemError where none opens.
    void renewDevice();

    const Program& program() const { return now.program; }
    /// Whether kernels are still being compiled behind: then meshes and pictures will change without another
    /// call.
    bool compiling();

    /// Why pictures are drafts, and stay so: Session::whyDraft().
    std::string whyDraft() { return session.whyDraft(); }

    /// The program with the values that it has now and the samples of its particles, for the host to
    /// evaluate.
    Program programOnHost() const { return session.onHost(); }
    /// The samples of the particles' fields as they were made last, for the host.
    std::vector<FieldVolumePtr> particleVolumes() const { return session.particleVolumes(); }
    /// Places for particles that fly now, of which some may be empty.
    uint64_t particles() const { return session.particleSlots(); }

    const Device& device() const { return session.device(); }
    /// Warnings: what its user should know of the graph's meshes.
    const std::vector<Error>& notes() const { return now.program.notes; }
    /// Pipelines that the device has built so far: what a seek leaves as it is.
    uint64_t pipelinesBuilt() const { return session.device().record->pipelines; }

  private:
    /// A document made ready to be played.
    struct Prepared : LiveProgram {
        std::optional<Box> region;      ///< shared by all times
        bool regionFound = false;       ///< rather than given
        bool regionIsProven = true;     ///< to hold the solid at all times of the timeline
        EnvironmentMapPtr environment;  ///< that the scene's sky names, if it names one
    };

    Player(Device device, PlayerOptions options_);
    Result<Prepared> prepare(Graph graph, const PlayerOptions& wishes) const;
    static Done findSharedRegion(Prepared& prepared, const PlayerOptions& options);
    void adopt(Prepared prepared);
    int askedResolution() const;
    /// Hands the session `now`'s program.
    void give();
    /// Does the work; where the device has no room for it, again with half of the cells.
    template <class Work>
    auto halvedIfFull(Work work) -> decltype(work());
    /// meshOnDevice(), or the mesh without the program's stages: an outline needs none.
    Result<MesherResult> makeMesh(bool stages, uint32_t show = RENDER_PICTURE);
    Result<bool> showTo(const RenderOptions& wishes, Picture* onHost);
    /// Calls draw(mesh, options) with all that a picture of now needs.
    template <class Draw>
    auto look(RenderOptions wishes, Draw draw) -> decltype(draw(MesherResult{}, wishes));
    /// Into how many moments a picture is parted, and the seconds between them.
    std::pair<int, double> shutter(const RenderOptions& wishes) const;

    Session session;
    MeshFieldBaker bake;  ///< on the session's device
    PlayerOptions options;
    /// seek() to where it was, for destructors: also if the device is lost.
    void goBack(double to) noexcept;

    Prepared now;
    std::map<std::string, std::vector<double>, std::less<>> chosen;  ///< by name, what set() was given
    double seconds = 0.0;
    bool lastCapped = false;
    Box lastRegion = {};
    int mostCells = 0;                    ///< as coarsen() was told
    int halvings = 0;                     ///< of the resolution, for want of room
    std::string full = {};                ///< why
    std::optional<MesherResult> meshed;   ///< of the values that the session has
    std::vector<gpu::MeshVertex> points;  ///< the outline; empty until it is asked for
};

}  // namespace fw
