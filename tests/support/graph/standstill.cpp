// A test that stands still ends the program by its name, rather than holding up whatever waits for it. It
// takes twenty minutes, that no slow machine is taken for one; a driver's compiler can stand still on a
// shader.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>

namespace fw::test {
namespace {

constexpr unsigned kSeconds = 20 * 60;
std::string running;  // set between alarms alone: a handler of signals may read it

class StandstillListener : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo& info) override {
        running =
            std::string(info.test_suite_name()) + "." + info.name() + " has not ended after 20 minutes\n";
        alarm(kSeconds);
    }
    void OnTestEnd(const testing::TestInfo&) override { alarm(0); }
};

const bool registered = [] {
    if (std::getenv("FIELDWRIGHT_LONG")) return false;
    std::signal(SIGALRM, [](int) {
        (void)!write(STDERR_FILENO, running.data(), running.size());
        _exit(1);
    });
    testing::UnitTest::GetInstance()->listeners().Append(new StandstillListener);
    return true;
}();

}  // namespace
}  // namespace fw::test
