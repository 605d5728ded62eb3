// SVG files: what they paint.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <string_view>

#include "graph/base/words.h"
#include "graph/outlines/drawing.h"
#include "graph/outlines/stroke.h"
#include "graph/outlines/svg_style.h"
#include "graph/outlines/svg_words.h"

namespace fw {

namespace {

constexpr double kSvgTolerance = 2e-6;          // of the page's longer side
constexpr double kPixel = 0.0254 / 96;          // metres
constexpr int kMostNested = 64;                 // elements within elements, with what `use` leads to
constexpr int kMostElements = 50'000;           // that are gone through, again for each `use`
constexpr double kMostPages = 10'000;           // from its page's centre, in longer sides of the page
constexpr std::size_t kMostRuled = 20'000'000;  // rules of styles held against elements
constexpr std::size_t kMostSvgArcs = 400'000;   // arcs, before those that are covered go

/// What an element has from those about it.
struct Inherited {
    SvgProperties style;
    double opacity = 1;
    std::vector<uint32_t> clips;
    PlaneTransform toPage;
    glm::dvec2 viewport{100, 100};  ///< user units
    bool chosen = true;
    std::string_view operator[](std::string_view property) const {
        const auto found = style.find(property);
        return found == style.end() ? std::string_view() : std::string_view(found->second);
    }
};

const std::set<std::string_view> kInheritedProperties = {"fill",
                                                         "fill-rule",
                                                         "fill-opacity",
                                                         "clip-rule",
                                                         "stroke",
                                                         "stroke-width",
                                                         "stroke-opacity",
                                                         "stroke-linecap",
                                                         "stroke-linejoin",
                                                         "stroke-miterlimit",
                                                         "stroke-dasharray",
                                                         "stroke-dashoffset",
                                                         "visibility",
                                                         "color"};
const std::set<std::string_view> kOwnProperties = {"opacity", "display",      "clip-path", "mask",
                                                   "filter",  "stop-opacity", "overflow"};

// ---- the reader

class SvgReader {
  public:
    SvgReader(const std::string& part_) : part(part_) {}

    Result<Drawing> run(const std::string& bytes) {
        pugi::xml_document document;
        const pugi::xml_parse_result parsed = document.load_buffer(bytes.data(), bytes.size());
        if (!parsed)
            return Error{
                "is damaged: " + std::string(parsed.description()) + ", in line " +
                std::to_string(
                    1 + std::count(bytes.begin(),
                                   bytes.begin() + std::min(parsed.offset, ptrdiff_t(bytes.size())), '\n'))};
        const pugi::xml_node root = document.document_element();
        if (nameOf(root) != "svg")
            return Error{"is no SVG: its outermost element is '" + std::string(nameOf(root)).substr(0, 40) +
                         "'"};
        index(document);
        std::ranges::stable_sort(rules, {}, &SvgRule::weight);

        Inherited page;
        const PlaneTransform inner = pageOf(root, page);
        page.toPage = inner;
        page.chosen = part.empty() || isPart(root);
        found = page.chosen;
        tolerance = kSvgTolerance;
        applyStyle(root, page);
        children(root, page, 0);
        if (problem) return *problem;
        if (!found)
            return Error{"has no element with the id or label " + inQuotes(part) +
                         (labels.empty() ? "" : ": it has " + listed({labels.begin(), labels.end()}))};
        if (drawing.painting.fills.empty())
            return Error{"paints nothing" + std::string(remarked.empty() ? "" : " but " + *remarked.begin())};
        for (const std::string& what : remarked)
            drawing.remarks.push_back("what it has of " + what + " is left away");
        return std::move(drawing);
    }

  private:
    static std::string_view nameOf(const pugi::xml_node& node) {
        const std::string_view whole = node.name();
        const std::size_t colon = whole.find(':');
        return colon == whole.npos ? whole : whole.substr(colon + 1);
    }
    static std::string_view get(const pugi::xml_node& node, const char* name) {
        return node.attribute(name).value();
    }
    static std::string_view labelOf(const pugi::xml_node& node) { return get(node, "inkscape:label"); }
    bool isPart(const pugi::xml_node& node) const { return get(node, "id") == part || labelOf(node) == part; }

    /// Ids, style sheets and labels, of the whole file.
    void index(const pugi::xml_node& document) {
        struct Walker : pugi::xml_tree_walker {
            SvgReader& reader;
            explicit Walker(SvgReader& reader_) : reader(reader_) {}
            bool for_each(pugi::xml_node& node) override {
                if (const std::string_view id = get(node, "id"); !id.empty()) reader.ids.emplace(id, node);
                if (const std::string_view label = labelOf(node); !label.empty())
                    reader.labels.emplace(label);
                if (nameOf(node) == "style") {
                    std::string sheet;
                    for (const pugi::xml_node& text : node.children()) sheet += text.value();
                    if (!addRules(sheet, reader.rules))
                        reader.remarked.insert("styles by the elements about an element");
                }
                return true;
            }
        } walker(*this);
        pugi::xml_node top = document;
        top.traverse(walker);
    }

    struct ViewBox {
        glm::dvec2 from, size;
    };
    static std::optional<ViewBox> viewBoxOf(const pugi::xml_node& node) {
        SvgWords words{get(node, "viewBox")};
        const auto x = words.number(), y = words.number(), w = words.number(), h = words.number();
        if (!(x && y && w && h && *w > 0 && *h > 0)) return std::nullopt;
        return ViewBox{{*x, *y}, {*w, *h}};
    }
    /// The element of the file that this one refers to; none if there is none.
    pugi::xml_node referred(const pugi::xml_node& node) const {
        std::string_view href = get(node, "href");
        if (href.empty()) href = get(node, "xlink:href");
        const auto found_ = href.starts_with('#') ? ids.find(href.substr(1)) : ids.end();
        return found_ == ids.end() ? pugi::xml_node() : found_->second;
    }

    /// From the root's user space to the drawing's unit.
    PlaneTransform pageOf(const pugi::xml_node& root, Inherited& page) {
        const std::optional<ViewBox> box = viewBoxOf(root);
        const auto side = [&](const char* name) {
            const std::string_view text = get(root, name);
            const auto length = text.ends_with('%') ? std::nullopt : lengthIn(text, 0);
            return length && *length > 0 ? length : std::nullopt;
        };
        const std::optional<double> width = side("width"), height = side("height");
        glm::dvec2 from{0}, size{width.value_or(height.value_or(100)), height.value_or(width.value_or(100))};
        double pixels = 1;  // of a user unit
        if (box) {
            from = box->from, size = box->size;
            if (width || height)
                pixels = std::min(width ? *width / size.x : 1e300, height ? *height / size.y : 1e300);
        }
        page.viewport = size;
        const double longer = std::max(size.x, size.y);
        drawing.scale = longer * pixels * kPixel;
        const glm::dvec2 centre = from + 0.5 * size;
        return {{1 / longer, 0}, {0, -1 / longer}, {-centre.x / longer, centre.y / longer}};
    }

    void applyStyle(const pugi::xml_node& node, Inherited& to) {
        SvgProperties own;
        const auto take = [&](std::string_view name, std::string_view value) {
            if (kOwnProperties.contains(name))
                own.insert_or_assign(std::string(name), std::string(value));
            else if (kInheritedProperties.contains(name) && value != "inherit")
                to.style.insert_or_assign(std::string(name), std::string(value));
        };
        for (const pugi::xml_attribute& attribute : node.attributes())
            take(attribute.name(), trimmed(attribute.value()));
        std::set<std::string, std::less<>> classes;
        std::istringstream words{std::string(get(node, "class"))};
        for (std::string word; words >> word;) classes.insert(word);
        ruled += rules.size();
        if (ruled > kMostRuled)
            return fail("has too many styles for its many elements (" + std::to_string(rules.size()) +
                        " for each): write them as attributes");
        for (const SvgRule& rule : rules)
            if ((rule.element.empty() || rule.element == nameOf(node)) &&
                (rule.id.empty() || rule.id == get(node, "id")) &&
                std::ranges::includes(classes, rule.classes))
                for (const auto& [name, value] : rule.properties) take(name, value);
        SvgProperties written;
        addDeclarations(get(node, "style"), written);
        for (const auto& [name, value] : written) take(name, value);

        if (const auto opacity = own.find("opacity"); opacity != own.end())
            to.opacity *= shareIn(opacity->second, 1);
        to.style.erase("display");
        if (const auto display = own.find("display"); display != own.end())
            to.style["display"] = display->second;
        if (const auto overflow = own.find("overflow"); overflow != own.end())
            to.style["overflow"] = overflow->second;
        else
            to.style.erase("overflow");
        if (const auto stop = own.find("stop-opacity"); stop != own.end())
            to.style["stop-opacity"] = stop->second;
        if (own.contains("mask") && own["mask"] != "none") remarked.insert("masks");
        if (own.contains("filter") && own["filter"] != "none") remarked.insert("filters");
        ownClip = own.contains("clip-path") ? own["clip-path"] : "";
    }

    /// Of an element that shows others through a page of its own.
    PlaneTransform viewOf(const pugi::xml_node& node, glm::dvec2 at, glm::dvec2 size, Inherited& to) {
        const std::optional<ViewBox> box = viewBoxOf(node);
        to.viewport = box ? box->size : size;
        if (!box) return {{1, 0}, {0, 1}, at};
        glm::dvec2 scale = size / box->size, share{0.5, 0.5};
        const std::string_view fit = get(node, "preserveAspectRatio");
        if (!fit.starts_with("none")) {
            scale = glm::dvec2(fit.find("slice") != fit.npos ? std::max(scale.x, scale.y)
                                                             : std::min(scale.x, scale.y));
            if (fit.find("xMin") != fit.npos) share.x = 0;
            if (fit.find("xMax") != fit.npos) share.x = 1;
            if (fit.find("YMin") != fit.npos) share.y = 0;
            if (fit.find("YMax") != fit.npos) share.y = 1;
        }
        const glm::dvec2 origin = at + share * (size - scale * box->size) - scale * box->from;
        return {{scale.x, 0}, {0, scale.y}, origin};
    }

    void children(const pugi::xml_node& node, const Inherited& about, int depth) {
        for (const pugi::xml_node& child : node.children()) element(child, about, depth + 1);
    }

    void element(const pugi::xml_node& node, const Inherited& about, int depth) {
        if (problem || node.type() != pugi::node_element) return;
        if (depth > kMostNested)
            return fail("has elements within elements, or uses of uses, more than " +
                        std::to_string(kMostNested) + " deep");
        if (++elements > kMostElements)
            return fail("draws more than " + std::to_string(kMostElements) +
                        " elements, those that it uses again included: simplify it");
        static const std::set<std::string_view> silent = {"defs",
                                                          "symbol",
                                                          "clipPath",
                                                          "mask",
                                                          "marker",
                                                          "filter",
                                                          "pattern",
                                                          "linearGradient",
                                                          "radialGradient",
                                                          "metadata",
                                                          "title",
                                                          "desc",
                                                          "style",
                                                          "script",
                                                          "namedview",
                                                          "cursor",
                                                          "view",
                                                          "animate",
                                                          "animateTransform",
                                                          "set",
                                                          "animateMotion",
                                                          "solidColor",
                                                          "font",
                                                          "font-face",
                                                          "color-profile",
                                                          "foreignObject"};
        const std::string_view name = nameOf(node);
        if (silent.contains(name) || std::string_view(node.name()).starts_with("sodipodi:")) {
            if (name == "foreignObject") remarked.insert("foreign objects");
            return;
        }
        Inherited here = about;
        const bool named = !part.empty() && isPart(node);
        here.chosen |= named;
        found |= named;
        applyStyle(node, here);
        const std::string clip = ownClip;
        if (here["display"] == "none" && !named) return;
        if (const std::string_view text = get(node, "transform"); !text.empty()) {
            const std::optional<PlaneTransform> transform = transformOf(text);
            if (!transform) remarked.insert("transforms that are damaged, with what they move");
            if (!transform) return;
            here.toPage = here.toPage * *transform;
        }
        if (!clip.empty() && clip != "none") addClip(idOfUrl(clip), here, depth);
        const auto length = [&](const char* attribute, double whole, double otherwise) {
            return lengthIn(get(node, attribute), whole).value_or(otherwise);
        };
        const glm::dvec2 page = about.viewport;
        if (name == "g" || name == "a") return children(node, here, depth);
        if (name == "switch") {
            for (const pugi::xml_node& child : node.children())
                if (child.type() == pugi::node_element && nameOf(child) != "foreignObject")
                    return element(child, here, depth + 1);
            return;
        }
        if (name == "svg") {
            const glm::dvec2 at{length("x", page.x, 0), length("y", page.y, 0)},
                size{length("width", page.x, page.x), length("height", page.y, page.y)};
            return view(node, at, size, here, depth);
        }
        if (name == "use") return use(node, here, depth);
        if (name == "text" || name == "image") {
            if (here.chosen) remarked.insert(name == "text" ? "text (turn it into paths)" : "pictures");
            return;
        }
        if (!here.chosen || here["visibility"] == "hidden" || here["visibility"] == "collapse") return;
        paint(shapeOf(node, here), here);
    }

    void view(const pugi::xml_node& node, glm::dvec2 at, glm::dvec2 size, Inherited here, int depth) {
        if (!(size.x > 0 && size.y > 0)) return;
        if (here["overflow"] != "visible") {
            Pen pen(1);
            pen.moveTo(at), pen.lineTo({at.x + size.x, at.y}), pen.lineTo(at + size),
                pen.lineTo({at.x, at.y + size.y});
            pen.close();
            here.clips.push_back(uint32_t(drawing.painting.clips.size()));
            drawing.painting.clips.push_back({Fill{moved(pen.taken(), here.toPage, tolerance)}});
        }
        here.toPage = here.toPage * viewOf(node, at, size, here);
        children(node, here, depth);
    }

    void use(const pugi::xml_node& node, Inherited here, int depth) {
        const pugi::xml_node target = referred(node);
        if (!target) return void(remarked.insert("uses of what is not in the file"));
        const glm::dvec2 page = here.viewport;
        const auto length = [&](const char* attribute, double whole, double otherwise) {
            return lengthIn(get(node, attribute), whole).value_or(otherwise);
        };
        here.toPage =
            here.toPage * PlaneTransform{{1, 0}, {0, 1}, {length("x", page.x, 0), length("y", page.y, 0)}};
        const std::string_view name = nameOf(target);
        if (name != "symbol" && name != "svg") return element(target, here, depth + 1);
        if (depth + 1 > kMostNested || ++elements > kMostElements)
            return element(target, here, kMostNested + 1);
        applyStyle(target, here);
        const auto side = [&](const char* attribute, double whole) {
            return length(attribute, whole, lengthIn(get(target, attribute), whole).value_or(whole));
        };
        view(target, {0, 0}, {side("width", page.x), side("height", page.y)}, here, depth + 1);
    }

    void addClip(std::string_view id, Inherited& here, int depth) {
        const auto target = ids.find(id);
        if (target == ids.end() || nameOf(target->second) != "clipPath") return;
        if (get(target->second, "clipPathUnits") == "objectBoundingBox")
            return void(remarked.insert("clips by bounding boxes"));
        // What it draws goes into a painting of its own.
        Drawing own;
        std::swap(drawing, own);
        Inherited inside = here;
        inside.chosen = true, inside.opacity = 1, inside.clips.clear();
        for (const char* property : {"fill", "stroke", "fill-opacity", "visibility"})
            inside.style.erase(property);
        if (const auto transform = transformOf(get(target->second, "transform")))
            inside.toPage = inside.toPage * *transform;
        clipping = true;
        children(target->second, inside, depth + 1);
        clipping = false;
        std::swap(drawing, own);
        here.clips.push_back(uint32_t(drawing.painting.clips.size()));
        for (Fill& fill : own.painting.fills) fill.clips.clear();
        drawing.painting.clips.push_back(std::move(own.painting.fills));
    }

    /// Contours in user units.
    std::vector<Contour> shapeOf(const pugi::xml_node& node, const Inherited& here) {
        const double scale = greatestScale(here.toPage);
        if (!(scale > 0) || !std::isfinite(scale)) return {};
        Pen pen(tolerance / scale);
        const glm::dvec2 page = here.viewport;
        const auto get_ = [&](const char* attribute, double whole) {
            return lengthIn(get(node, attribute), whole);
        };
        const double diagonal = std::sqrt(0.5 * glm::dot(page, page));
        const std::string_view name = nameOf(node);
        constexpr double turn = 2 * std::numbers::pi;
        if (name == "path") {
            if (!drawPath(get(node, "d"), pen, kMostSvgArcs))
                remarked.insert("paths behind a mistake in them");
        } else if (name == "rect") {
            const double x = get_("x", page.x).value_or(0), y = get_("y", page.y).value_or(0);
            const double w = get_("width", page.x).value_or(0), h = get_("height", page.y).value_or(0);
            if (!(w > 0 && h > 0)) return {};
            const auto rx_ = get_("rx", page.x), ry_ = get_("ry", page.y);
            const double rx = std::clamp(rx_ ? *rx_ : ry_.value_or(0), 0.0, 0.5 * w),
                         ry = std::clamp(ry_ ? *ry_ : rx_.value_or(0), 0.0, 0.5 * h);
            if (rx > 0 && ry > 0) {
                pen.moveTo({x + rx, y});
                pen.ellipse({x + w - rx, y + ry}, {rx, 0}, {0, ry}, -0.25 * turn, 0);
                pen.ellipse({x + w - rx, y + h - ry}, {rx, 0}, {0, ry}, 0, 0.25 * turn);
                pen.ellipse({x + rx, y + h - ry}, {rx, 0}, {0, ry}, 0.25 * turn, 0.5 * turn);
                pen.ellipse({x + rx, y + ry}, {rx, 0}, {0, ry}, 0.5 * turn, 0.75 * turn);
            } else {
                pen.moveTo({x, y}), pen.lineTo({x + w, y}), pen.lineTo({x + w, y + h}),
                    pen.lineTo({x, y + h});
            }
            pen.close();
        } else if (name == "circle" || name == "ellipse") {
            const glm::dvec2 centre{get_("cx", page.x).value_or(0), get_("cy", page.y).value_or(0)};
            const auto r = get_("r", diagonal), rx_ = get_("rx", page.x), ry_ = get_("ry", page.y);
            const double rx = name == "circle" ? r.value_or(0)
                              : rx_            ? *rx_
                                               : ry_.value_or(0),
                         ry = name == "circle" ? r.value_or(0)
                              : ry_            ? *ry_
                                               : rx_.value_or(0);
            if (!(rx > 0 && ry > 0)) return {};
            pen.moveTo(centre + glm::dvec2(rx, 0));
            pen.ellipse(centre, {rx, 0}, {0, ry}, 0, turn);
            pen.close();
        } else if (name == "line") {
            pen.moveTo({get_("x1", page.x).value_or(0), get_("y1", page.y).value_or(0)});
            pen.lineTo({get_("x2", page.x).value_or(0), get_("y2", page.y).value_or(0)});
        } else if (name == "polyline" || name == "polygon") {
            SvgWords words{get(node, "points")};
            bool first = true;
            while (const auto x = words.number()) {
                const auto y = words.number();
                if (!y) break;
                if (std::exchange(first, false))
                    pen.moveTo({*x, *y});
                else
                    pen.lineTo({*x, *y});
                if (pen.arcs() > kMostSvgArcs) break;
            }
            if (name == "polygon") pen.close();
        }
        return pen.taken();
    }

    /// How opaque a paint is; 0: none.
    double opacityOf(std::string_view paint, std::string_view opacity) {
        if (paint == "none" || paint == "transparent") return 0;
        double paintsOwn = 1;
        if (const std::string_view id = idOfUrl(paint); paint.starts_with("url(")) {
            const auto target = ids.find(id);
            if (target == ids.end()) {
                const std::size_t end = paint.find(')');
                const std::string_view rest = end == paint.npos ? "" : trimmed(paint.substr(end + 1));
                if (rest.empty() || rest == "none") return 0;
            } else {
                paintsOwn = gradientOpacity(target->second, 0);
            }
        } else if (paint.starts_with("rgba(") || paint.starts_with("hsla(")) {
            const std::size_t comma = paint.find_last_of(",/");
            paintsOwn = shareIn(paint.substr(std::min(comma + 1, paint.size())), 1);
        }
        return paintsOwn * shareIn(opacity, 1);
    }

    /// Of its most transparent stop: what fades is a shadow or a gleam.
    double gradientOpacity(const pugi::xml_node& node, int depth) {
        double least = 2;
        for (const pugi::xml_node& stop : node.children())
            if (nameOf(stop) == "stop") {
                Inherited style;
                const std::string kept = ownClip;
                applyStyle(stop, style);
                ownClip = kept;
                least = std::min(least, shareIn(style["stop-opacity"], 1));
            }
        if (least <= 1) return least;
        if (depth > 8) return 0;
        const pugi::xml_node next = referred(node);
        if (!next) return nameOf(node) == "pattern" ? 1 : 0;
        return gradientOpacity(next, depth + 1);
    }

    void paint(std::vector<Contour> contours, const Inherited& here) {
        std::erase_if(contours, [](const Contour& contour) { return contour.arcs.empty(); });
        if (contours.empty()) return;
        const auto isSeen = [&](double opacity) { return opacity * here.opacity >= 0.5 - 1e-9; };
        const auto hasRoomFor = [&](const std::vector<Contour>& more, std::size_t each) {
            std::size_t count = drawn;
            for (const Contour& contour : more) count += each * contour.arcs.size();
            if (count >= kMostSvgArcs)
                fail("draws more than " + std::to_string(kMostSvgArcs) + " arcs: simplify its paths");
            return !problem;
        };
        const auto add = [&](Fill fill) {
            if (!hasRoomFor(fill.contours, 1)) return;
            for (const Contour& contour : fill.contours) {
                drawn += contour.arcs.size();
                for (const Arc& arc : contour.arcs)
                    if (!(std::max(std::abs(arc.a.x), std::abs(arc.a.y)) < kMostPages))
                        return fail("draws more than " + std::to_string(int(kMostPages)) +
                                    " times as far away as its page is long: bring it onto its page");
            }
            fill.clips = here.clips;
            drawing.painting.fills.push_back(std::move(fill));
        };
        const bool filled = clipping || isSeen(opacityOf(here["fill"].empty() ? "black" : here["fill"],
                                                         here["fill-opacity"])),
                   stroked = !clipping && !here["stroke"].empty() &&
                             isSeen(opacityOf(here["stroke"], here["stroke-opacity"]));
        if (filled || stroked) {
            const std::vector<Contour> paths = moved(contours, here.toPage, tolerance);
            if (!clipping) drawing.paths.insert(drawing.paths.end(), paths.begin(), paths.end());
            if (filled) add({paths, here[clipping ? "clip-rule" : "fill-rule"] == "evenodd"});
        }
        if (!stroked) return;
        const double diagonal = std::sqrt(0.5 * glm::dot(here.viewport, here.viewport));
        StrokeStyle style;
        style.width = lengthIn(here["stroke-width"], diagonal).value_or(1);
        if (!(style.width > 0)) return;
        const std::string_view join = here["stroke-linejoin"], cap = here["stroke-linecap"];
        if (join == "round") style.join = StrokeStyle::Join::round;
        if (join == "bevel") style.join = StrokeStyle::Join::bevel;
        if (cap == "round") style.cap = StrokeStyle::Cap::round;
        if (cap == "square") style.cap = StrokeStyle::Cap::square;
        style.miterLimit = std::max(1.0, lengthIn(here["stroke-miterlimit"], 1).value_or(4));
        style.dashOffset = lengthIn(here["stroke-dashoffset"], diagonal).value_or(0);
        if (const std::string_view dashes = here["stroke-dasharray"]; !dashes.empty() && dashes != "none") {
            std::string text(dashes);
            std::ranges::replace(text, ',', ' ');
            std::istringstream words(text);
            double sum = 0;
            for (std::string word; words >> word && style.dashes.size() < 64;) {
                const auto dash = lengthIn(word, diagonal);
                if (!dash || *dash < 0) return;
                style.dashes.push_back(*dash);
                sum += *dash;
            }
            if (!(sum > 0)) style.dashes.clear();
        }
        constexpr std::size_t kArcsOfAStroke = 4;  // at least, for each of its path
        if (hasRoomFor(contours, kArcsOfAStroke))
            add({moved(strokeOf(contours, style), here.toPage, tolerance)});
    }

    void fail(std::string message) {
        if (!problem) problem = Error{std::move(message)};
    }

    const std::string& part;
    Drawing drawing;
    std::map<std::string, pugi::xml_node, std::less<>> ids;
    std::vector<SvgRule> rules;
    std::set<std::string> labels, remarked;
    std::optional<Error> problem;
    std::string ownClip;  ///< of the element whose style was applied last
    double tolerance = kSvgTolerance;
    std::size_t drawn = 0, ruled = 0;
    int elements = 0;
    bool found = false, clipping = false;
};

}  // namespace

Result<Drawing> readSvg(const std::string& bytes, const std::string& part) {
    return SvgReader(part).run(bytes);
}

}  // namespace fw
