// Work that nobody waits for yet, such as compiling kernels that will be of use later.
#pragma once

namespace fw {

/// Lets other threads go before the calling one, and before those that it starts from now on, wherever there
/// are too few processors. It cannot be taken back. Does nothing where a system knows no priority of a
/// thread.
void workBehind();

}  // namespace fw
