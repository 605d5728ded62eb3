// CancelFlag: a flag that ends work under way, for code that reads an atomic and for code that takes a
// std::stop_token.
//
// Thread safety: request(), the value and token() may be used by several threads at once. reset() must not
// run while another thread calls request() or token().
#pragma once

#include <atomic>
#include <stop_token>

namespace fw {

class CancelFlag : public std::atomic<bool> {
  public:
    CancelFlag() : std::atomic<bool>(false) {}

    void request() {
        store(true);
        source.request_stop();
    }
    /// For the next work; tokens that were given out stay stopped.
    void reset() {
        store(false);
        source = std::stop_source();
    }
    std::stop_token token() const { return source.get_token(); }

  private:
    std::stop_source source;
};

}  // namespace fw
