#include "tests/support/gpu.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace fw::test {
namespace {

Device* shared = nullptr;

/// Fails the test during which the validation layer spoke of any device.
class ValidationListener : public testing::EmptyTestEventListener {
  public:
    void look(const char* when) {
        std::vector<std::string> all = validationMessages();
        for (; seen < all.size(); ++seen) ADD_FAILURE() << "validation layer" << when << ": " << all[seen];
    }
    void forget() { seen = validationMessages().size(); }

  private:
    void OnTestEnd(const testing::TestInfo&) override { look(""); }
    std::size_t seen = 0;
};

ValidationListener* listener = nullptr;

/// Destroys the device before the program's statics go, since the validation layer has some of its own.
class DeviceEnvironment : public testing::Environment {
    void TearDown() override {
        delete std::exchange(shared, nullptr);
        listener->look(", at the end");
    }
};

const bool registered = [] {
    testing::AddGlobalTestEnvironment(new DeviceEnvironment);
    testing::UnitTest::GetInstance()->listeners().Append(listener = new ValidationListener);
    return true;
}();

}  // namespace

void forgetValidationMessages() { listener->forget(); }

Device& device() {
    if (!shared) {
        const char* off = std::getenv("FIELDWRIGHT_VALIDATION");
        Result<Device> made = createDevice({.validation = !off || std::string(off) != "0"});
        if (!made) throw SystemError(format(made.error()));
        shared = new Device(std::move(*made));
    }
    return *shared;
}

Pipeline computePipeline(const std::string& text, const std::vector<uint32_t>& constants,
                         const std::string& field) {
    return createComputePipeline(device(),
                                 {.name = "test.comp", .field = field, .constants = constants, .text = text});
}

TemporaryCache::TemporaryCache() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fieldwright-cache-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw SystemError("cannot make a temporary folder");
    folder = pattern;
    if (const char* value = std::getenv("XDG_CACHE_HOME")) {
        had = true;
        previous = value;
    }
    setenv("XDG_CACHE_HOME", folder.c_str(), 1);
}

TemporaryCache::~TemporaryCache() {
    if (had)
        setenv("XDG_CACHE_HOME", previous.c_str(), 1);
    else
        unsetenv("XDG_CACHE_HOME");
    std::error_code error;
    std::filesystem::remove_all(folder, error);
}

}  // namespace fw::test
