// Calls of lib3mf, whose interface is C's. For whoever reads or writes 3MF.
#pragma once

#include <Model/COM/NMR_DLLInterfaces.h>

#include <cstdio>
#include <memory>
#include <string>

namespace fw::lib3mf {

using namespace NMR;

struct Release {
    void operator()(PLib3MFBase* object) const { lib3mf_release(object); }
};
/// What lib3mf has made.
using Object = std::unique_ptr<PLib3MFBase, Release>;

/// Calls of lib3mf up to the first that fails; later ones are given null objects, which they refuse.
struct Calls {
    std::string failure;

    bool check(LIB3MFRESULT code, const Object& object) {
        if (code == LIB3MF_OK || !failure.empty()) return failure.empty();
        LPCSTR text = nullptr;
        DWORD number = 0;
        if (object) lib3mf_getlasterror(object.get(), &number, &text);
        char fallback[32];
        std::snprintf(fallback, sizeof fallback, "lib3mf failed (%x)", static_cast<unsigned>(code));
        failure = text && *text ? text : fallback;
        return false;
    }
    /// What `function`, called on `object` with `arguments`, puts behind the pointer it is given last.
    template <class Function, class... Arguments>
    Object make(Function function, const Object& object, Arguments... arguments) {
        PLib3MFBase* made = nullptr;
        check(function(object.get(), arguments..., &made), object);
        return Object(made);
    }
};

inline Object emptyModel(Calls& calls) {
    PLib3MFBase* made = nullptr;
    calls.check(lib3mf_createmodel(&made), nullptr);
    return Object(made);
}

}  // namespace fw::lib3mf
