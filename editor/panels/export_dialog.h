// The dialog that makes a mesh file of the document. It stays open beside the work: an export runs on while
// the document is edited, and while the dialog is closed.
//
// Lifetime: part of the Editor; the job is the last export, until the next one.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "editor/files/browser.h"
#include "editor/files/export_job.h"
#include "editor/panels/staying_dialog.h"

namespace fw::editor {

struct Editor;

struct ExportDialog : StayingDialog {
    /// What is asked of the document that is shown; of another one it begins anew.
    struct OfDocument {
        uint64_t document = 0;     ///< Viewport::document
        std::string path = {};     ///< as typed or chosen; empty: the one proposed
        bool givesRegion = false;  ///< else found from the solid
        std::array<double, 6> region = {-1, -1, -1, 1, 1, 1};  ///< least corner, greatest corner, metres
        std::optional<double> seconds = {};                    ///< on the timeline; none: what is seen
    } of;
    std::string ending = ".glb";        ///< of what is proposed
    bool givesResolution = false;       ///< else the output node's
    int resolution = 256;               ///< cells along the longest side
    bool functions = false;             ///< in place of a mesh, where the format has them
    MeshWish file = {};                 ///< what files are to be like; of it a format takes what it has
    std::optional<int> triangles = {};  ///< at most
    FileBrowser browser;
    std::unique_ptr<ExportJob> job = {};
    bool told = true;  ///< what came of the job was said
};

/// Opens it, or brings it to the front. A file beside the document's is proposed.
void openExport(Editor& editor);
/// Where the file goes: as typed, else beside the document's.
std::string exportPath(const Editor& editor);
/// One frame of it, if it is open; says what came of an export that ended while it was not.
void showExport(Editor& editor);
/// Whether an export is under way.
bool exports(const Editor& editor);

/// Whether nothing is wrong with the mesh, or else what: "12 open edges".
std::string soundness(const Report& report);

}  // namespace fw::editor
