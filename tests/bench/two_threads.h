// Both processors of the machines that the benchmark is meant for, for the plain C++ that it compares with.
#pragma once

#include <thread>

namespace fw::bench {

/// Calls work(0) and work(1) at the same time.
template <class Work>
void onTwoThreads(Work&& work) {
    std::thread other([&] { work(1); });
    work(0);
    other.join();
}

}  // namespace fw::bench
