#include "tests/support/faults.h"

#include <cstdlib>

namespace fw::test {

std::vector<std::string> Faults::environment(const Fault& fault) {
    std::vector<std::string> entries = {"VK_ADD_LAYER_PATH=" FIELDWRIGHT_BINARY_DIR "/layers",
                                        "VK_INSTANCE_LAYERS=VK_LAYER_FIELDWRIGHT_faulty"};
    std::string list;
    for (const long at : fault.lose) list += std::to_string(at) + " ";
    if (!list.empty()) entries.push_back("FAULTY_LOSE=" + list);
    if (!fault.loseWhenThere.empty()) entries.push_back("FAULTY_LOSE_FILE=" + fault.loseWhenThere);
    if (fault.presenting) entries.push_back("FAULTY_PRESENTING=" + std::to_string(*fault.presenting));
    if (fault.memory) entries.push_back("FAULTY_MEMORY=" + std::to_string(*fault.memory));
    if (fault.mapped) entries.push_back("FAULTY_MAPPED=" + std::to_string(*fault.mapped));
    return entries;
}

Faults::Faults(const Fault& fault) {
    for (const std::string& entry : environment(fault)) {
        const std::size_t equals = entry.find('=');
        setenv(entry.substr(0, equals).c_str(), entry.c_str() + equals + 1, 1);
    }
}

Faults::~Faults() {
    for (const char* name : {"VK_ADD_LAYER_PATH", "VK_INSTANCE_LAYERS", "FAULTY_LOSE", "FAULTY_LOSE_FILE",
                             "FAULTY_PRESENTING", "FAULTY_MEMORY", "FAULTY_MAPPED"})
        unsetenv(name);
}

}  // namespace fw::test
