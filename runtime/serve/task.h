// A request that is being answered.
#pragma once

#include <functional>
#include <memory>

#include "runtime/serve/message.h"
#include "runtime/system/cancel_flag.h"
#include "runtime/system/clock.h"

namespace fw::serve {

/// Tells the client what is done of a part of the work, from 0 to 1.
using Tell = std::function<void(const char* part, double done)>;

inline constexpr double kTellEveryMs = 100;

/// Tells whenever a part begins, and between that some times a second.
inline Tell seldom(Tell tell) {
    return [tell = std::move(tell), last = Clock::now()](const char* part, double done) mutable {
        if (done > 0.0 && millisecondsSince(last) < kTellEveryMs) return;
        last = Clock::now();
        tell(part, done);
    };
}

struct Task {
    Request request;
    CancelFlag cancelled;  ///< looked at wherever work can end
    Tell tell = {};        ///< may be empty

    void progress(const char* part, double done) const {
        if (tell) tell(part, done);
    }
};
using TaskPtr = std::shared_ptr<Task>;

inline Fault cancelledFault() { return {kCancelled, "cancelled"}; }

}  // namespace fw::serve
