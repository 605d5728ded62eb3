// The bytes between the server and one client: lines and blobs in, messages out.
//
// One thread reads; any may send, each message whole. Neither side's end is a failure: reading ends, and what
// is sent then goes nowhere.
#pragma once

#include <atomic>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/serve/message.h"

namespace fw::serve {

class Wire {
  public:
    /// Descriptors of files, pipes or a socket, which stay its owner's and may be the same.
    Wire(int in, int out);
    Wire(const Wire&) = delete;
    ~Wire();

    enum class Read { line, tooLong, end };
    /// The next line, without its end. What is longer than kMostMessageBytes is passed over.
    Read line(std::string& text);
    /// The next `size` bytes; false at the end.
    bool bytes(char* to, std::size_t size);
    bool skip(std::size_t size);

    /// False once the client is gone.
    bool send(std::string_view line, std::span<const Blob> blobs = {});
    bool gone() const { return lost; }

    /// Whoever reads sees the end, now or next. From any thread.
    void endReading();

  private:
    /// More into the buffer, of which all was taken; false at the end.
    bool fill();

    const int in, out;
    int wake[2] = {-1, -1};  // a pipe: its end ends reading
    std::vector<char> buffer;
    std::size_t taken = 0, filled = 0;
    std::mutex sending;
    std::atomic<bool> lost = false;
};

}  // namespace fw::serve
