// What falls on a G-buffer and what is shown in its place: lamps, fog, sun and sky
// (shaders/render/light.comp), the reference for ambient occlusion, and the views into mesh and field.
//
// Pipelines are made when they are first asked for, as most pictures want few of them.
#pragma once

#include "runtime/render/renderer.h"

namespace fw {

/// Ambient occlusion by many rays, none of which is kept, in place of drawAmbient.
void traceReference(Commands& commands, Renderer& renderer, const RenderScene& scene);

/// What lamps.comp defines.
std::vector<std::string> lampDefines(bool tracesSun);

/// Makes renderer.pixels of the G-buffer, and adds them to the mean if there is one. False if the commands
/// are cancelled, before the mean is added to.
bool lightFrame(Commands& commands, Renderer& renderer, const RenderScene& scene,
                const RenderOptions& options, bool mean);

/// LightPicture::color of the last picture, which was to have it.
std::vector<float> readLight(const Renderer& renderer, const RenderOptions& options);

/// Draws what RenderOptions::show asks for over the picture.
void showView(Commands& commands, Renderer& renderer, const RenderScene& scene);

}  // namespace fw
