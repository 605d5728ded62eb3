// The module fieldwright._native: graphs in the process of Python, asked as `fieldwright serve` is.
//
// A document takes the requests of docs/server.md and gives their results as JSON, with blobs as arrays of
// numpy: one table of methods serves both, and both give the same bytes. Arrays that the document will not
// touch again are the document's own memory, read-only, kept until the last of them goes. The package's
// Python (fieldwright/) makes of this what people call.
//
// The lock of the interpreter is released while a document works, in a thread of its own: the caller's thread
// waits and looks for signals, so that Ctrl-C cancels what runs. Documents work beside each other.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "graph/document/json.h"
#include "graph/library/reference.h"
#include "runtime/render/picture.h"
#include "runtime/serve/document.h"

namespace py = pybind11;

namespace fw::python {
namespace {

constexpr std::chrono::milliseconds kLooksForSignals(50);

/// The calls that work, of which none may when the interpreter ends: it would end their threads within.
class Calls {
  public:
    /// One of them, while it lives. Once the interpreter ends it ends its thread, as SystemExit does.
    class Call {
      public:
        explicit Call(serve::Task& task_) : task(task_) {
            const std::lock_guard lock(mutex);
            endThread();
            tasks.insert(&task);
        }
        /// Of what was cancelled for that.
        void endIfAllEnds() const {
            const std::lock_guard lock(mutex);
            endThread();
        }
        Call(const Call&) = delete;
        ~Call() {
            const std::lock_guard lock(mutex);
            tasks.erase(&task);
            gone.notify_all();
        }

      private:
        serve::Task& task;
    };

    /// Cancels all, and waits until they have gone.
    static void end() {
        const py::gil_scoped_release released;
        std::unique_lock lock(mutex);
        ending = true;
        for (serve::Task* task : tasks) task->cancelled.request();
        gone.wait(lock, [] { return tasks.empty(); });
    }

  private:
    static void endThread() {
        if (!ending) return;
        PyErr_SetNone(PyExc_SystemExit);
        throw py::error_already_set();
    }

    static inline std::mutex mutex;
    static inline std::condition_variable gone;
    static inline std::set<serve::Task*> tasks;
    static inline bool ending = false;
};

/// The class fieldwright.Error, made by the package from what there is of a fault.
void raise(const serve::Fault& fault) {
    Json data = serve::findingJson(fault.error);
    data["message"] = fault.error.message;
    data["code"] = fault.code;
    data["where"] = format(fault.error);
    if (!fault.findings.empty()) data["findings"] = serve::findingsJson(fault.findings);
    const py::object kind = py::module_::import("fieldwright").attr("Error");
    const py::object error = kind.attr("_of")(serve::inLine(data));
    PyErr_SetObject(kind.ptr(), error.ptr());
    throw py::error_already_set();
}

py::dtype dtypeOf(const std::string& type) {
    return type == "f32"   ? py::dtype::of<float>()
           : type == "f64" ? py::dtype::of<double>()
           : type == "u32" ? py::dtype::of<uint32_t>()
                           : py::dtype::of<uint8_t>();
}

py::object arrayOf(const serve::Blob& blob, const std::shared_ptr<const void>& keeps) {
    if (blob.shape.empty()) return py::bytes(blob.bytes.data(), blob.bytes.size());
    const std::vector<py::ssize_t> shape(blob.shape.begin(), blob.shape.end());
    if (!keeps) return py::array(dtypeOf(blob.type), shape, blob.bytes.data());
    const py::capsule owner(new std::shared_ptr<const void>(keeps),
                            [](void* kept) { delete static_cast<std::shared_ptr<const void>*>(kept); });
    py::array array(dtypeOf(blob.type), shape, blob.bytes.data(), owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}

class Document {
  public:
    explicit Document(std::string device) : document([device] { return createDevice({.pick = device}); }) {}

    /// The result as JSON, and its blobs by name.
    py::tuple ask(const std::string& method, const std::string& params) {
        const auto& methods = serve::Document::methods();
        const auto found =
            std::ranges::find(methods, method, &std::pair<std::string, serve::Document::Method>::first);
        if (found == methods.end() && method != "open") throw py::value_error("no method " + method);
        const serve::Document::Method asked = found != methods.end() ? found->second : &serve::Document::open;
        const Json given = Json::parse(params, nullptr, false);
        if (given.is_discarded())
            throw py::value_error(method + ": a number is beyond double precision, or a text is not UTF-8");
        serve::Task task;
        serve::Answer answer = worked(task, [&]() -> serve::Answer {
            serve::Params read(given, method);
            return serve::guarded(document, [&] { return (document.*asked)(read, task); });
        });
        if (const serve::Fault* fault = std::get_if<serve::Fault>(&answer)) raise(*fault);
        const serve::Reply& reply = std::get<serve::Reply>(answer);
        py::dict blobs;
        for (const serve::Blob& blob : reply.blobs) blobs[blob.name.c_str()] = arrayOf(blob, reply.keeps);
        return py::make_tuple(serve::inLine(reply.result), blobs);
    }

    py::str parameters() const { return serve::inLine(document.parameters()); }

    using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

    /// Of points, n x 3: distances, and, if asked for, gradients.
    py::object eval(const Numbers& points, bool gradient) {
        const auto count = std::size_t(points.shape(0));
        Numbers distances(points.shape(0));
        Numbers gradients(std::vector<py::ssize_t>{gradient ? points.shape(0) : 0, 3});
        const double* const from = points.data();
        double* const values = distances.mutable_data();
        double* const slopes = gradient ? gradients.mutable_data() : nullptr;
        withField([&](const Tape& tape, serve::Task& task) {
            serve::evaluateAll(tape, from, count, values, slopes, task.cancelled);
        });
        if (!gradient) return distances;
        return py::make_tuple(distances, gradients);
    }

    /// Of boxes, n x 2 x 3, least corners before greatest ones: the ends of intervals, n x 2.
    Numbers bounds(const Numbers& boxes) {
        const auto count = std::size_t(boxes.shape(0));
        Numbers ends(std::vector<py::ssize_t>{boxes.shape(0), 2});
        const double* const from = boxes.data();
        double* const to = ends.mutable_data();
        withField([&](const Tape& tape, serve::Task& task) {
            TapeMachine<double> machine;
            for (std::size_t i = 0; i < count && !task.cancelled; ++i) {
                const double* const box = from + 6 * i;
                const Interval range =
                    machine.interval(tape, Box{{box[0], box[1], box[2]}, {box[3], box[4], box[5]}});
                to[2 * i] = range.lo, to[2 * i + 1] = range.hi;
            }
        });
        return ends;
    }

  private:
    /// Does work in a thread of its own, one at a time, while this one waits without the interpreter's lock.
    template <class Work>
    serve::Answer worked(serve::Task& task, const Work& work) {
        const Calls::Call call(task);
        auto done = std::async(std::launch::async, [&]() -> serve::Answer {
            std::unique_lock lock(*one, std::defer_lock);
            while (!lock.try_lock_for(kLooksForSignals))
                if (task.cancelled) return serve::cancelledFault();
            return work();
        });
        bool interrupted = false;
        for (;;) {
            {
                const py::gil_scoped_release released;
                if (done.wait_for(kLooksForSignals) == std::future_status::ready) break;
            }
            if (!interrupted && PyErr_CheckSignals() != 0) {
                interrupted = true;
                task.cancelled.request();
            }
        }
        if (interrupted) throw py::error_already_set();
        call.endIfAllEnds();
        return done.get();
    }
    template <class Work>
    void withField(const Work& work) {
        serve::Task task;
        const serve::Answer answer = worked(task, [&]() -> serve::Answer {
            return serve::guarded(document, [&]() -> serve::Answer {
                const auto field = document.field(task);
                if (const serve::Fault* fault = std::get_if<serve::Fault>(&field)) return *fault;
                work(*std::get<const Tape*>(field), task);
                return serve::Reply{};
            });
        });
        if (const serve::Fault* fault = std::get_if<serve::Fault>(&answer)) raise(*fault);
    }

    std::unique_ptr<std::timed_mutex> one = std::make_unique<std::timed_mutex>();
    serve::Document document;
};

/// The graph's text as `fieldwright` writes it.
std::string canonical(const std::string& text, const std::string& path) {
    const Result<Graph> graph = parseGraph(text, path, nullptr);
    if (!graph) raise(graph.error());
    return writeGraph(*graph);
}

/// Writes the graph of this text as the editor does: the file is there whole, or as it was.
void saveText(const std::string& text, const std::string& from, const std::string& path) {
    const Result<Graph> graph = parseGraph(text, from, nullptr);
    if (!graph) raise(graph.error());
    if (const Done saved = saveGraph(*graph, path); !saved) raise(saved.error());
}

void savePng(const py::array_t<uint8_t, py::array::c_style | py::array::forcecast>& pixels,
             const std::string& path) {
    const Picture picture{.width = int(pixels.shape(1)),
                          .height = int(pixels.shape(0)),
                          .pixels = {pixels.data(), pixels.data() + pixels.size()},
                          .alpha = true};
    if (const Done saved = savePicture(picture, path); !saved) raise(saved.error());
}

}  // namespace
}  // namespace fw::python

PYBIND11_MODULE(_native, module) {
    using fw::python::Document;
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            std::rethrow_exception(thrown);
        } catch (const fw::SystemError& error) { PyErr_SetString(PyExc_OSError, error.what()); }
    });
    module.attr("version") = FIELDWRIGHT_VERSION;
    module.def("nodes", &fw::nodesJson);
    module.def("canonical", &fw::python::canonical);
    module.def("save_text", &fw::python::saveText);
    module.def("end", &fw::python::Calls::end);
    module.def("save_png", &fw::python::savePng);
    py::class_<Document>(module, "Document")
        .def(py::init<std::string>())
        .def("ask", &Document::ask)
        .def("parameters", &Document::parameters)
        .def("eval", &Document::eval)
        .def("bounds", &Document::bounds);
}
