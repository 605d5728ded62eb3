// Options that several commands have.
#pragma once

#include <CLI/CLI.hpp>

#include "runtime/cli/commands.h"

namespace fw::cli {

/// The graph file, and values of its parameters.
void addGraph(CLI::App* command, GraphOptions& graph);
/// The same at a time, with a cache of its particles.
void addMoment(CLI::App* command, GraphOptions& graph);
/// The same, and how finely it is meshed, and on which device.
void addMesh(CLI::App* command, MeshOptions& mesh);
/// What a command takes that makes a file for every frame.
void addSequence(CLI::App* command, SequenceOptions& sequence);
/// What of it one of several machines makes.
void addPart(CLI::App* command, SequenceOptions& sequence);
/// Refuses --time beside --fps, when all is parsed: one moment, or a file for every frame.
void oneMomentOrMany(const CLI::App* command);
/// A report on the mesh, and what it must be.
void addMeasures(CLI::App* command, MeshOutput& output);
/// Progress as engines that run jobs read it.
void addOpenJd(CLI::App* command);
/// By which of the two ways the field is shown.
void addQuality(CLI::App* command, FieldBy& quality);

}  // namespace fw::cli
