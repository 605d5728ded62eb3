#include "editor/panels/render_dialog.h"

#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "editor/editor.h"
#include "editor/panels/properties.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;
using RenderPhase = RenderState::Phase;

const std::vector<std::string> kSubjects = {"a picture", "frames of the timeline",
                                            "frames of the timeline's range", "a turntable"};
const std::vector<std::string> kQualities = {"as the field and the device allow",
                                             "full: light through the field", "draft: of the mesh alone"};
constexpr FieldBy kFieldBy[] = {FieldBy::sooner, FieldBy::kernels, FieldBy::tapes};

struct Size {
    const char* name;
    int width, height;
};
constexpr Size kSizes[] = {{"1280 × 720", 1280, 720},
                           {"1920 × 1080", 1920, 1080},
                           {"3840 × 2160", 3840, 2160},
                           {"1080 × 1080", 1080, 1080},
                           {"1080 × 1920", 1080, 1920}};

bool isSequence(const RenderDialog& dialog) { return dialog.subject != RenderSubject::still; }

std::string endingOf(const RenderDialog& dialog) { return "." + nameOf(dialog.picture.format); }

/// What was typed, of a still or of frames; empty: what is proposed counts.
std::string& typedPath(RenderDialog& dialog) {
    return isSequence(dialog) ? dialog.of.folder : dialog.of.file;
}

/// Where it goes: as typed, else beside the document's file.
std::string pathOf(Editor& editor) {
    RenderDialog& dialog = editor.rendering;
    if (const std::string& typed = typedPath(dialog); !typed.empty()) return typed;
    const char* frames = dialog.subject == RenderSubject::turntable ? "_turntable" : "_frames";
    return (fs::path(workFolder(editor)) /
            (stemOf(editor) + (isSequence(dialog) ? std::string(frames) : endingOf(dialog))))
        .string();
}

double secondsOf(const Editor& editor) {
    return editor.rendering.of.seconds.value_or(editor.viewport.seconds);
}

/// The frames that are asked for. Errors: there are none.
Result<FrameRange> framesOf(Editor& editor) {
    const RenderDialog& dialog = editor.rendering;
    const Timeline* timeline = timelineOf(editor);
    const Timeline none;
    const Timeline& all = timeline ? *timeline : none;
    const double rate = dialog.of.framesPerSecond > 0.0 ? dialog.of.framesPerSecond : all.framesPerSecond;
    switch (dialog.subject) {
        case RenderSubject::turntable: return framesBetween(0.0, dialog.turn, rate);
        case RenderSubject::range:
            if (!all.range) return Error{.message = "the timeline has no range: set one in its ruler's menu"};
            return framesBetween(all.range->from, all.range->to, rate);
        default: return framesBetween(0.0, all.length, rate);
    }
}

void showPlace(Editor& editor) {
    RenderDialog& dialog = editor.rendering;
    const float scale = editor.shell.scale();
    propertyRow(isSequence(dialog) ? "Folder" : "File",
                isSequence(dialog)
                    ? "A frame is a file in it, named after its number. Those that are there stay: so "
                      "what was stopped goes on."
                    : "",
                90.0f * scale);
    std::string path = pathOf(editor);
    if (ImGui::InputText("##path", &path)) typedPath(dialog) = path;
    ImGui::SameLine(0, 4 * scale);
    if (ImGui::Button("Browse …", {-1, 0})) {
        dialog.browser.endings.clear();
        if (!isSequence(dialog)) dialog.browser.endings.push_back(endingOf(dialog));
        open(dialog.browser, isSequence(dialog) ? FileBrowser::Kind::folder : FileBrowser::Kind::save, path);
    }
}

void showFormat(RenderDialog& dialog) {
    propertyRow("Format",
                "PNG is what a display shows. OpenEXR is light before exposure and tone map, with "
                "depth, normals, materials and alpha.");
    const bool light = dialog.picture.format == PictureFormat::exr;
    const auto choose = [&](PictureFormat format) {
        dialog.picture.format = format;
        std::string& typed = dialog.of.file;
        if (!typed.empty()) typed = fs::path(typed).replace_extension(nameOf(format)).string();
    };
    if (ImGui::RadioButton("PNG", !light)) choose(PictureFormat::png);
    ImGui::SameLine();
    if (ImGui::RadioButton("OpenEXR", light)) {
        choose(PictureFormat::exr);
        dialog.picture.view = RENDER_PICTURE;
    }
}

void showSize(Editor& editor) {
    RenderDialog& dialog = editor.rendering;
    PictureWish& wish = dialog.picture;
    propertyRow("Size", "Pixels.");
    const auto shown = std::ranges::find_if(
        kSizes, [&](const Size& size) { return size.width == wish.width && size.height == wish.height; });
    const bool known = shown != std::end(kSizes);
    if (ImGui::BeginCombo("##size", known ? shown->name : "as typed")) {
        for (const Size& size : kSizes)
            if (ImGui::Selectable(size.name, known && &size == shown))
                wish.width = size.width, wish.height = size.height;
        if (ImGui::Selectable("as the viewport is") && editor.viewport.width() > 0)
            wish.width = editor.viewport.width(), wish.height = editor.viewport.height();
        ImGui::EndCombo();
    }
    propertyRow("   width, height");
    const double now[] = {double(wish.width), double(wish.height)};
    dragNumbers(
        editor, "##pixels", now,
        {.min = double(kLeastPictureSide), .max = double(kMostPictureSide), .speed = 1.0, .whole = true},
        [&wish](std::span<const double> to) {
            wish.width = int(std::lround(to[0])), wish.height = int(std::lround(to[1]));
        });
}

void showTimes(Editor& editor) {
    RenderDialog& dialog = editor.rendering;
    const bool rests = dialog.subject == RenderSubject::still || dialog.subject == RenderSubject::turntable;
    if (rests && !editor.graph->timeline->is_null()) {
        propertyRow("Time", "The moment of the timeline that is shown.");
        const double seconds = secondsOf(editor);
        dragNumbers(editor, "##time", std::span(&seconds, 1), {.min = 0.0, .unit = "s"},
                    [&dialog](std::span<const double> to) { dialog.of.seconds = to[0]; });
    }
    if (dialog.subject == RenderSubject::turntable) {
        propertyRow("Once around in");
        dragNumbers(editor, "##turn", std::span(&dialog.turn, 1), {.min = 0.04, .max = 3600.0, .unit = "s"},
                    [&dialog](std::span<const double> to) { dialog.turn = to[0]; });
    }
    if (!isSequence(dialog)) return;
    const Timeline* timeline = timelineOf(editor);
    const double rate = dialog.of.framesPerSecond > 0.0 ? dialog.of.framesPerSecond
                                                        : (timeline ? *timeline : Timeline()).framesPerSecond;
    propertyRow("Frames a second");
    dragNumbers(editor, "##rate", std::span(&rate, 1),
                {.min = 0.1, .max = kMostFramesPerSecond, .speed = 0.2},
                [&dialog](std::span<const double> to) { dialog.of.framesPerSecond = to[0]; });
    propertyRow("Frames there are", "Those of the same size are passed over; or made anew.");
    ImGui::Checkbox("made anew##overwrite", &dialog.overwrite);
}

/// A number of the dialog, which outlives the frame.
void dragWhole(Editor& editor, const char* id, int& number, NumberRange range) {
    range.whole = true;
    const double now = number;
    dragNumbers(editor, id, std::span(&now, 1), range,
                [&number](std::span<const double> to) { number = int(std::lround(to[0])); });
}

void showLight(Editor& editor) {
    RenderDialog& dialog = editor.rendering;
    PictureWish& wish = dialog.picture;
    const bool light = wish.format == PictureFormat::exr;
    propertyRow("Shows", "The picture, or a look inside.");
    ImGui::BeginDisabled(light);  // which is of the picture alone
    std::size_t view = wish.view;
    if (chooseName("##view", renderViews(), view)) wish.view = uint32_t(view);
    ImGui::EndDisabled();
    const bool picture = wish.view == RENDER_PICTURE;
    propertyRow("Samples",
                "Frames that a picture is the mean of: of edges, soft shadows and ambient occlusion.");
    dragWhole(editor, "##samples", wish.samples, {.min = 1, .max = kMostSamples, .speed = 0.2});
    propertyRow("Camera");
    ImGui::Checkbox("as the viewport sees it##camera", &dialog.asSeen);
    ImGui::BeginDisabled(!picture);
    propertyRow("Background");
    ImGui::Checkbox("transparent: the solid alone##transparent", &wish.transparent);
    ImGui::EndDisabled();
    propertyRow("Quality");
    ImGui::BeginDisabled(wish.reference);
    std::size_t quality = std::size_t(std::ranges::find(kFieldBy, wish.quality) - std::begin(kFieldBy));
    if (chooseName("##quality", kQualities, quality)) wish.quality = kFieldBy[quality];
    ImGui::EndDisabled();
    propertyRow("Reference",
                "The ground truth, by rays traced to their ends: it takes long, and goes on where it was "
                "stopped where paths of light are traced.");
    ImGui::BeginDisabled(!picture);
    ImGui::Checkbox("trace the field itself##reference", &wish.reference);
    ImGui::EndDisabled();
    if (wish.reference && picture) {
        propertyRow("   bounces",
                    "Paths of light reflected by up to so many surfaces. 0: as many as the solid needs.");
        dragWhole(editor, "##bounces", wish.bounces, {.min = 0, .max = kMostBounces, .speed = 0.1});
    }
}

void showRenderSettings(Editor& editor) {
    RenderDialog& dialog = editor.rendering;
    if (!beginProperties("render")) return;
    propertyRow("Make");
    std::size_t subject = std::size_t(dialog.subject);
    if (chooseName("##subject", kSubjects, subject)) dialog.subject = RenderSubject(subject);
    showPlace(editor);
    showFormat(dialog);
    showSize(editor);
    showTimes(editor);
    showLight(editor);
    endProperties();
}

/// The dialog's wish of the document as it is. Errors: there is no frame.
Result<RenderWish> wishOf(Editor& editor) {
    RenderDialog& dialog = editor.rendering;
    RenderWish wish{.graph = editor.graph,
                    .path = pathOf(editor),
                    .picture = dialog.picture,
                    .seconds = secondsOf(editor),
                    .turntable = dialog.subject == RenderSubject::turntable,
                    .overwrite = dialog.overwrite,
                    .device = editor.device};
    const bool picture = wish.picture.view == RENDER_PICTURE;
    wish.picture.reference = wish.picture.reference && picture;
    wish.picture.transparent = wish.picture.transparent && picture;
    if (!wish.picture.reference) wish.picture.bounces = 0;
    if (isSequence(dialog)) {
        const Result<FrameRange> frames = framesOf(editor);
        if (!frames) return frames.error();
        wish.frames = *frames;
    }
    const Viewport& view = editor.viewport;
    if (dialog.asSeen) wish.camera = view.camera();
    return wish;
}

void begin(Editor& editor, RenderWish wish) {
    RenderDialog& dialog = editor.rendering;
    if (!dialog.queue) dialog.queue = std::make_unique<RenderQueue>([] { Shell::wake(); });
    dialog.awaited.insert(dialog.queue->add(std::move(wish)));
    dialog.looked = 0;
}

std::string duration(double seconds) {
    const long whole = std::lround(seconds);
    char text[32];
    std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
    return text;
}

/// "frame 12 of 120, 0:42 left"
std::string progressOf(const RenderItem& item) {
    const RenderState& state = item.state;
    if (state.cancelling) return "cancelling …";
    if (!item.wish.frames || state.ready == 0) return state.stage;
    const long all = item.wish.frames->count();
    std::string words = "frame " + std::to_string(state.ready) + " of " + std::to_string(all);
    if (state.made > 0)
        words += ", " + duration(state.seconds / double(state.made) * double(all - state.ready)) + " left";
    return words;
}

void showItem(RenderDialog& dialog, const RenderItem& item, float scale) {
    const RenderState& state = item.state;
    const bool runs = state.phase == RenderPhase::running || state.phase == RenderPhase::waiting;
    const float buttons = 200.0f * scale;
    const std::string name = fs::path(item.wish.path).filename().string();
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    if (ImGui::Selectable("##item", item.id == dialog.looked, ImGuiSelectableFlags_AllowItemOverlap,
                          {width, 2.0f * line}))
        dialog.looked = item.id;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", item.wish.path.c_str());
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec4 clip(at.x, at.y, at.x + width - buttons, at.y + 2.0f * line);
    list->AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, themeColor(ThemeColor::text), name.c_str(),
                  nullptr, 0.0f, &clip);
    const ImU32 color = state.phase == RenderPhase::failed ? themeColor(ThemeColor::error)
                                                           : ImGui::GetColorU32(ImGuiCol_TextDisabled);
    list->AddText(ImGui::GetFont(), ImGui::GetFontSize(), {at.x, at.y + line}, color, wordsOf(item).c_str(),
                  nullptr, 0.0f, &clip);
    if (state.phase == RenderPhase::running) {
        const float low = at.y + 2.0f * line - 3.0f * scale, right = at.x + width - buttons - 8.0f * scale;
        list->AddRectFilled({at.x, low}, {right, low + 2.0f * scale}, ImGui::GetColorU32(ImGuiCol_FrameBg));
        list->AddRectFilled({at.x, low}, {at.x + state.part * (right - at.x), low + 2.0f * scale},
                            ImGui::GetColorU32(ImGuiCol_PlotHistogram));
    }
    ImGui::SetCursorScreenPos({at.x + width - buttons, at.y + 0.4f * line});
    RenderQueue& queue = *dialog.queue;
    if (runs) {
        ImGui::BeginDisabled(state.cancelling);
        if (ImGui::SmallButton("Cancel")) queue.cancel(item.id);
        ImGui::EndDisabled();
        return ImGui::SetCursorScreenPos({at.x, at.y + 2.2f * line});
    }
    if (state.phase != RenderPhase::done) {
        if (ImGui::SmallButton("Go on")) queue.goOn(item.id), dialog.awaited.insert(item.id);
        ImGui::SameLine();
    }
    if (ImGui::SmallButton("Take off the list")) queue.remove(item.id);
    ImGui::SetCursorScreenPos({at.x, at.y + 2.2f * line});
}

/// The picture of what is looked at, as it grows, and what else there is to say of it.
void showPicture(Editor& editor, const std::vector<RenderItem>& items) {
    RenderDialog& dialog = editor.rendering;
    const auto chosen = std::ranges::find(items, dialog.looked, &RenderItem::id);
    const RenderItem* item = chosen != items.end() ? &*chosen : nullptr;
    for (const RenderItem& each : items)  // what was last worked at
        if (chosen == items.end() && (each.state.picture || !each.state.problems.empty())) item = &each;
    if (!item) return;
    if (item->state.picture) {
        const Picture& picture = *item->state.picture;
        if (dialog.textured != item->state.picture) {
            dialog.texture = editor.shell.show(dialog.texture, picture);
            dialog.textured = item->state.picture;
        }
        const float room = ImGui::GetContentRegionAvail().x, high = 260.0f * editor.shell.scale();
        const float fits = std::min(room / float(picture.width), high / float(picture.height));
        ImGui::Image(dialog.texture, {fits * float(picture.width), fits * float(picture.height)});
    }
    if (item->state.again)
        wrapped(themeColor(ThemeColor::warning), "The device was lost: it went on on another.");
    for (const std::string& note : item->state.notes)
        wrapped(themeColor(ThemeColor::warning), "Note: " + note);
    for (const Error& problem : item->state.problems) wrapped(themeColor(ThemeColor::error), format(problem));
}

/// How many of the frames lie in the folder already. While nothing is made they are counted now and then, for
/// others may put some there; of very many only when others are asked for.
long framesThere(Editor& editor, const RenderWish& wish, const std::vector<RenderItem>& items) {
    constexpr long kMany = 1000;
    RenderDialog::Counted& counted = editor.rendering.counted;
    const FrameFiles files = filesOf(sequenceOf(wish));
    const std::string asked = files.path(files.frames.first) + files.path(files.frames.last - 1) +
                              std::to_string(wish.picture.width) + "x" + std::to_string(wish.picture.height);
    long made = 0;
    for (const RenderItem& item : items) made += item.state.made;
    const double now = ImGui::GetTime();
    const bool old = made != counted.made || (now > counted.seconds + 1.0 && counted.there < kMany);
    if (asked != counted.asked || (old && !renders(editor))) counted = {asked, made, now, files.countThere()};
    return counted.there;
}

void showRenderButtons(Editor& editor, const std::vector<RenderItem>& items) {
    RenderDialog& dialog = editor.rendering;
    const ImVec2 size{110 * editor.shell.scale(), 0};
    Result<RenderWish> wish = wishOf(editor);
    std::string wrong = wish ? "" : wish.error().message;
    std::error_code error;
    const std::string path = pathOf(editor);
    if (!isSequence(dialog) && fs::path(path).extension() != endingOf(dialog)) {
        wrong = "The name has to end in " + endingOf(dialog) + ".";
    } else if (!isSequence(dialog) && fs::exists(path, error)) {
        wrapped(themeColor(ThemeColor::warning),
                fs::path(path).filename().string() + " is there and will be replaced.");
    } else if (wish && wish->frames) {
        wrapped(themeColor(ThemeColor::text), std::to_string(wish->frames->count()) + " frames.");
        if (const long there = framesThere(editor, *wish, items); there > 0)
            wrapped(themeColor(ThemeColor::warning),
                    std::to_string(there) + (dialog.overwrite ? " are there and will be replaced."
                                                              : " are there and stay as they are."));
    }
    if (!wrong.empty()) wrapped(themeColor(ThemeColor::error), wrong);
    ImGui::BeginDisabled(!wrong.empty());
    if (ImGui::Button(renders(editor) ? "Add to the list" : "Render", size)) begin(editor, std::move(*wish));
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("Close", size)) dialog.open = false;
}

/// Says of what has ended, while nobody watched, what came of it.
void tell(Editor& editor, const std::vector<RenderItem>& items) {
    RenderDialog& dialog = editor.rendering;
    for (const RenderItem& item : items) {
        const RenderPhase phase = item.state.phase;
        if (phase == RenderPhase::waiting || phase == RenderPhase::running) {
            dialog.awaited.insert(item.id);
        } else if (dialog.awaited.erase(item.id) > 0 && !dialog.open) {
            say(editor, fs::path(item.wish.path).filename().string() + ": " + wordsOf(item));
        }
    }
}

}  // namespace

std::string wordsOf(const RenderItem& item) {
    const RenderState& state = item.state;
    switch (state.phase) {
        case RenderPhase::done:
            if (!item.wish.frames) return "done";
            return std::to_string(state.made) + " frames made" +
                   (state.passed > 0 ? ", " + std::to_string(state.passed) + " were there" : "");
        case RenderPhase::failed: return state.problems.front().message;
        case RenderPhase::cancelled:
            return item.wish.frames ? "cancelled after " + std::to_string(state.ready) + " frames"
                                    : "cancelled";
        default: return progressOf(item);
    }
}

bool renders(const Editor& editor) { return editor.rendering.queue && editor.rendering.queue->busy(); }

void openRender(Editor& editor) {
    RenderDialog& dialog = editor.rendering;
    dialog.of.seconds.reset();
    dialog.open = dialog.toFront = true;
}

void showRender(Editor& editor) {
    RenderDialog& dialog = editor.rendering;
    const std::vector<RenderItem> items = dialog.queue ? dialog.queue->items() : std::vector<RenderItem>();
    tell(editor, items);
    const uint64_t document = editor.viewport.document;
    if (dialog.of.document != document) dialog.of = {.document = document};
    if (items.empty() && dialog.texture) {
        editor.shell.forget(std::exchange(dialog.texture, nullptr));
        dialog.textured.reset();
    }
    const float scale = editor.shell.scale();
    showStaying(dialog, "Render", 540.0f * scale, 0.04f, [&] {
        showRenderSettings(editor);
        showRenderButtons(editor, items);
        if (!items.empty()) ImGui::Separator();
        for (const RenderItem& item : items) {
            ImGui::PushID(int(item.id));
            showItem(dialog, item, scale);
            ImGui::PopID();
        }
        if (!items.empty()) showPicture(editor, items);
        const auto path = show(dialog.browser, scale);
        if (path) typedPath(dialog) = *path;
        return path.has_value();
    });
}

}  // namespace fw::editor
