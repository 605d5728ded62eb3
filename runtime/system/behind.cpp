#include "runtime/system/behind.h"

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace fw {

void workBehind() {
#ifdef __linux__
    // A tenth of a processor where all are busy: enough that a lock is given back soon.
    constexpr int kNice = 10;
    // Of this thread alone, other than POSIX has it.
    const auto thread = id_t(gettid());
    if (getpriority(PRIO_PROCESS, thread) < kNice) setpriority(PRIO_PROCESS, thread, kNice);
#endif
}

}  // namespace fw
