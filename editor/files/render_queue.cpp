#include "editor/files/render_queue.h"

#include <algorithm>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <thread>
#include <utility>

#include "editor/files/attempt.h"
#include "runtime/export/outputs.h"
#include "runtime/pictures/kept_paths.h"
#include "runtime/system/cancel_flag.h"
#include "runtime/system/clock.h"
#include "runtime/system/output_file.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;
using RenderPhase = RenderState::Phase;

constexpr float kOpened = 0.05f;  // part of the work before the first picture, about
constexpr int kKeptSide = 1024;   // pixels of the pictures that are kept to look at

}  // namespace

struct RenderQueue::Shared {
    std::function<void()> changed;
    mutable std::mutex mutex;
    std::condition_variable woken;
    std::vector<RenderItem> items;
    uint64_t last = 0;     // id given
    uint64_t running = 0;  // id; 0: none
    CancelFlag cancel;
    bool ends = false;
    std::thread thread;

    RenderItem* find(uint64_t id) {
        const auto at = std::ranges::find(items, id, &RenderItem::id);
        return at == items.end() ? nullptr : &*at;
    }
    /// Changes the state of what runs.
    void change(const std::function<void(RenderState&)>& how) {
        {
            std::lock_guard lock(mutex);
            if (RenderItem* item = find(running)) how(item->state);
        }
        if (changed) changed();
    }
    void start(const char* stage, float part) {
        change([&](RenderState& now) { now.stage = stage, now.part = part; });
    }
    void note(std::string words) {
        change([&](RenderState& now) { now.notes.push_back(std::move(words)); });
    }
    void show(Picture picture) {
        auto shown = std::make_shared<const Picture>(std::move(picture));
        change([&](RenderState& now) { now.picture = std::move(shown); });
    }

    Result<Player> open(const RenderWish& wish);
    Done still(const RenderWish& wish, Player& player);
    Done sequence(const RenderWish& wish, Player& player);
    Done make(const RenderWish& wish);
    void run(const RenderWish& wish);
    void work();
    // Of what runs:
    std::vector<Error> findings;  ///< errors of the graph, where they ended it
    bool capped = false;          ///< the surface leaves the region in one of the pictures made

    inline static const Error kStopped{.message = "cancelled"};
};

SequenceWish sequenceOf(const RenderWish& wish) {
    SequenceWish frames{.picture = wish.picture,
                        .folder = wish.path,
                        .frames = *wish.frames,
                        .overwrite = wish.overwrite,
                        .camera = wish.camera};
    if (wish.turntable) frames.turntable = wish.seconds;
    return frames;
}

namespace {

/// Whether a file can be made there: what took hours must not end at its writing.
Done checkWritable(const std::string& path) {
    const Result<OutputFile> file = OutputFile::open(path, nullptr);
    return file ? done() : Done(file.error());
}

/// Whether the wish's files can be where it wants them. A sequence's folder is made.
Done makePlace(const RenderWish& wish) {
    if (const Done fits = checkPictureSize(wish.picture.width, wish.picture.height); !fits) return fits;
    if (wish.frames) {
        std::error_code failure;
        if (fs::exists(wish.path, failure) && !fs::is_directory(wish.path, failure))
            return Error{.message = wish.path + " is a file: a sequence goes into a folder"};
        const SequenceWish frames = sequenceOf(wish);
        if (const Done free = checkFrames(frames, *wish.graph); !free) return free;
        fs::create_directories(wish.path, failure);
        if (!fs::is_directory(wish.path, failure))
            return Error{.message = wish.path + ": cannot make the folder: " + failure.message()};
        return checkWritable(filesOf(frames).path(frames.frames.first));
    }
    if (lowerExtension(wish.path) != "." + nameOf(wish.picture.format))
        return Error{.message = wish.path + ": the name has to end in ." + nameOf(wish.picture.format)};
    if (const Done distinct = checkDistinct(wish.graph->path, {wish.path}); !distinct) return distinct;
    if (const Done kept = checkReplacesNone(filesRead(*wish.graph), {wish.path}); !kept) return kept;
    return checkWritable(wish.path);
}

/// The picture with the means of k x k pixels in place of them, for the least k by which no side is longer.
std::shared_ptr<const Picture> reduced(const std::shared_ptr<const Picture>& picture, int longest) {
    if (!picture) return nullptr;
    const int k = (std::max(picture->width, picture->height) + longest - 1) / longest;
    if (k <= 1) return picture;
    auto small = std::make_shared<Picture>();
    small->width = std::max(picture->width / k, 1), small->height = std::max(picture->height / k, 1);
    small->alpha = picture->alpha;
    small->pixels.resize(4 * std::size_t(small->width) * std::size_t(small->height));
    for (std::size_t i = 0; i < small->pixels.size(); ++i) {
        const int x = int(i / 4) % small->width * k, y = int(i / 4) / small->width * k;
        const int right = std::min(x + k, picture->width), low = std::min(y + k, picture->height);
        int sum = 0;
        for (int v = y; v < low; ++v)
            for (int u = x; u < right; ++u)
                sum +=
                    picture
                        ->pixels[4 * (std::size_t(v) * std::size_t(picture->width) + std::size_t(u)) + i % 4];
        const int count = (right - x) * (low - y);
        small->pixels[i] = uint8_t((sum + count / 2) / count);
    }
    return small;
}

}  // namespace

Result<Player> RenderQueue::Shared::open(const RenderWish& wish) {
    start("checking the graph", 0.0f);
    // Once more, if the device was lost: frames that are there are counted anew.
    change([](RenderState& now) { now.ready = now.passed = now.made = 0, now.seconds = 0.0; });
    if (const Done place = makePlace(wish); !place) return place.error();
    findings = errorsOf(*wish.graph);
    if (!findings.empty()) return findings.front();
    if (cancel) return kStopped;
    start("opening the device", 0.01f);
    Result<Device> device = createDevice(wish.device);
    if (!device) return device.error();
    if (cancel) return kStopped;
    start("compiling for the device", 0.02f);
    PlayerOptions options{.liveParameters = false, .fieldBy = renderedBy(wish.picture)};
    options.simulating = [this](int done, int all) {
        if (done == 1) start("simulating", kOpened);
        change([&](RenderState& now) { now.part = kOpened * float(done) / float(std::max(all, 1)); });
        return !cancel;
    };
    options.stop = [this] { return cancel.token(); };
    return Player::create(*wish.graph, std::move(*device), options);
}

Done RenderQueue::Shared::still(const RenderWish& wish, Player& player) {
    player.seek(wish.seconds);
    RenderOptions render = renderOptions(wish.picture, player);
    render.scene.camera = wish.camera;
    render.cancel = &cancel;
    render.progress = [this](int percent) {
        change([&](RenderState& now) { now.part = kOpened + (1.0f - kOpened) * 0.01f * float(percent); });
    };
    render.grows = [this](Picture picture) { show(std::move(picture)); };
    LightPicture light;
    if (wish.picture.format == PictureFormat::exr) render.light = &light;
    std::optional<KeptPaths> kept;
    if (tracesPaths(render)) {
        kept.emplace(wish.path, player, render);
        if (const int paths = kept->goOn(render); paths > 0)
            note("went on from " + std::to_string(paths) + " samples that were kept");
    }
    if (leavesOutFog(render, player)) note("paths of light leave out the scene's fog");
    start("tracing light", kOpened);
    Result<Picture> picture = player.frame(render);
    if (!picture) return picture.error();
    const auto isThere = [&] {
        if (kept) kept->remove();
    };
    if (const Done written = save(*picture, light, wish.picture.format, wish.path, isThere); !written)
        return written;
    capped = player.capped();
    change([](RenderState& now) { now.ready = now.made = 1; });
    show(std::move(*picture));
    return done();
}

Done RenderQueue::Shared::sequence(const RenderWish& wish, Player& player) {
    const SequenceWish frames = sequenceOf(wish);
    const FrameFiles files = filesOf(frames);
    RenderOptions render = renderOptions(wish.picture, player);
    render.framesPerSecond = frames.frames.framesPerSecond;
    render.cancel = &cancel;
    LightPicture light;
    if (wish.picture.format == PictureFormat::exr) render.light = &light;
    start("tracing light", kOpened);
    const auto count = float(frames.frames.count());
    for (long frame = frames.frames.first; frame < frames.frames.last; ++frame) {
        if (cancel) return kStopped;
        const bool there = files.isThere(frame);
        const Clock::time_point begin = Clock::now();
        if (!there) {
            Result<Picture> picture = onceMoreIfLost([&] { return drawFrame(player, frames, frame, render); },
                                                     [&] {
                                                         player.renewDevice();
                                                         change([](RenderState& now) { now.again = true; });
                                                     });
            if (!picture) return picture.error();
            if (const Done written = save(*picture, light, wish.picture.format, files.path(frame)); !written)
                return written;
            capped = capped || player.capped();
            show(std::move(*picture));
        }
        change([&](RenderState& now) {
            ++now.ready;
            ++(there ? now.passed : now.made);
            if (!there) now.seconds += secondsSince(begin);
            now.part = kOpened + (1.0f - kOpened) * float(frame + 1 - frames.frames.first) / count;
        });
    }
    return done();
}

Done RenderQueue::Shared::make(const RenderWish& wish) {
    Result<Player> player = open(wish);
    if (!player) return player.error();
    if (cancel) return kStopped;
    const Done made = wish.frames ? sequence(wish, *player) : still(wish, *player);
    if (!made) return made;
    if (const std::string why = player->whyDraft(); !why.empty() && wish.picture.quality == FieldBy::sooner)
        note("a draft, of the mesh alone: " + why);
    if (const std::optional<Error> coarser = player->coarser()) note(coarser->message);
    if (capped) note("the surface leaves the region and was closed at its boundary");
    return done();
}

void RenderQueue::Shared::run(const RenderWish& wish) {
    std::error_code none;
    const bool fresh = wish.frames && !fs::exists(wish.path, none);
    const Done made =
        attempt([&] { return make(wish); }, [this] { change([](RenderState& now) { now.again = true; }); },
                "make the picture smaller, or lower the resolution");
    if (fresh && !made) fs::remove(wish.path, none);  // which it only is if nothing was put there
    change([&](RenderState& now) {
        now.picture = reduced(now.picture, kKeptSide);
        if (made) {
            now.phase = RenderPhase::done, now.stage = "done", now.part = 1.0f;
        } else if (cancel) {
            now.phase = RenderPhase::cancelled, now.stage = "cancelled";
        } else {
            now.phase = RenderPhase::failed, now.stage = "failed";
            now.problems = findings.empty() ? std::vector{made.error()} : std::move(findings);
        }
    });
}

void RenderQueue::Shared::work() {
    for (;;) {
        RenderWish wish;
        {
            std::unique_lock lock(mutex);
            running = 0;
            auto next = items.end();
            woken.wait(lock, [&] {
                next = std::ranges::find(items, RenderPhase::waiting,
                                         [](const RenderItem& item) { return item.state.phase; });
                return ends || next != items.end();
            });
            if (ends) return;
            next->state = {.phase = RenderPhase::running};
            running = next->id;
            wish = next->wish;
            cancel.reset();
            capped = false;
            findings.clear();
        }
        run(wish);
    }
}

RenderQueue::RenderQueue(std::function<void()> changed) : shared(std::make_unique<Shared>()) {
    shared->changed = std::move(changed);
}

RenderQueue::~RenderQueue() {
    {
        std::lock_guard lock(shared->mutex);
        shared->ends = true;
        shared->cancel.request();
    }
    shared->woken.notify_all();
    if (shared->thread.joinable()) shared->thread.join();
}

uint64_t RenderQueue::add(RenderWish wish) {
    std::lock_guard lock(shared->mutex);
    shared->items.push_back({++shared->last, std::move(wish)});
    if (!shared->thread.joinable()) shared->thread = std::thread([state = shared.get()] { state->work(); });
    shared->woken.notify_all();
    return shared->last;
}

void RenderQueue::cancel(uint64_t id) {
    std::lock_guard lock(shared->mutex);
    RenderItem* item = shared->find(id);
    if (!item) return;
    if (item->state.phase == RenderPhase::waiting)
        item->state = {.phase = RenderPhase::cancelled, .stage = "cancelled"};
    if (item->state.phase == RenderPhase::running) {
        item->state.cancelling = true;
        shared->cancel.request();
    }
}

void RenderQueue::goOn(uint64_t id) {
    std::lock_guard lock(shared->mutex);
    RenderItem* item = shared->find(id);
    if (!item || (item->state.phase != RenderPhase::cancelled && item->state.phase != RenderPhase::failed))
        return;
    RenderItem again{id, item->wish};
    std::erase_if(shared->items, [&](const RenderItem& each) { return each.id == id; });
    shared->items.push_back(std::move(again));
    shared->woken.notify_all();
}

void RenderQueue::remove(uint64_t id) {
    std::lock_guard lock(shared->mutex);
    if (id == shared->running) {
        const RenderItem* item = shared->find(id);
        if (item && item->state.phase == RenderPhase::running) return;
    }
    std::erase_if(shared->items, [&](const RenderItem& each) { return each.id == id; });
}

std::vector<RenderItem> RenderQueue::items() const {
    std::lock_guard lock(shared->mutex);
    return shared->items;
}

bool RenderQueue::busy() const {
    std::lock_guard lock(shared->mutex);
    return std::ranges::any_of(shared->items, [](const RenderItem& item) {
        return item.state.phase == RenderPhase::waiting || item.state.phase == RenderPhase::running;
    });
}

}  // namespace fw::editor
