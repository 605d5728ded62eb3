// Which of the installed Vulkan drivers are loaded at all.
#pragma once

namespace fw {

/// Leaves out Mesa's drivers of graphics cards where the system has no such card: loading them takes longer
/// than finding out that they have no device. What the environment already says of drivers is kept. Call it
/// once, before other threads and before the first device: it may set a variable of the environment.
void passOverDriversWithoutCards();

}  // namespace fw
