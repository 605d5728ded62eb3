#include "runtime/serve/wire.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace fw::serve {

namespace {

constexpr std::size_t kBufferBytes = 256u << 10;
constexpr int kPipeBytes = 1 << 20;  // what a system allows without privileges: fewer turns for a mesh

}  // namespace

Wire::Wire(int in_, int out_) : in(in_), out(out_), buffer(kBufferBytes) {
    if (::pipe2(wake, O_CLOEXEC) != 0)
        throw SystemError("no pipe can be made: " + std::string(std::strerror(errno)));
    ::fcntl(out, F_SETPIPE_SZ, kPipeBytes);  // of all but pipes without effect
}

Wire::~Wire() {
    for (const int end : wake)
        if (end >= 0) ::close(end);
}

void Wire::endReading() {
    // Never emptied: whoever polls it sees it from now on.
    while (::write(wake[1], "", 1) < 0 && errno == EINTR) {}
}

bool Wire::fill() {
    for (;;) {
        pollfd ready[2] = {{in, POLLIN, 0}, {wake[0], POLLIN, 0}};
        if (::poll(ready, 2, -1) < 0 && errno != EINTR) return false;
        if (ready[1].revents != 0) return false;
        if (ready[0].revents == 0) continue;
        const ssize_t got = ::read(in, buffer.data(), buffer.size());
        if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        taken = 0, filled = std::size_t(std::max<ssize_t>(got, 0));
        return got > 0;
    }
}

Wire::Read Wire::line(std::string& text) {
    text.clear();
    bool tooLong = false;
    for (;;) {
        if (taken == filled && !fill()) return Read::end;
        const char* from = buffer.data() + taken;
        const auto* end = static_cast<const char*>(std::memchr(from, '\n', filled - taken));
        const std::size_t size = end ? std::size_t(end - from) : filled - taken;
        tooLong = tooLong || text.size() + size > kMostMessageBytes;
        if (tooLong)
            text = {};
        else
            text.append(from, size);
        taken += size + (end ? 1 : 0);
        if (end) return tooLong ? Read::tooLong : Read::line;
    }
}

bool Wire::bytes(char* to, std::size_t size) {
    while (size > 0) {
        if (taken == filled && !fill()) return false;
        const std::size_t count = std::min(size, filled - taken);
        if (to) std::memcpy(to, buffer.data() + taken, count), to += count;
        taken += count, size -= count;
    }
    return true;
}

bool Wire::skip(std::size_t size) { return bytes(nullptr, size); }

bool Wire::send(std::string_view line, std::span<const Blob> blobs) {
    std::vector<iovec> pieces;
    const auto add = [&](std::string_view bytes) {
        if (!bytes.empty()) pieces.push_back({const_cast<char*>(bytes.data()), bytes.size()});
    };
    add(line), add("\n");
    for (const Blob& blob : blobs) add(blob.bytes);
    const std::lock_guard lock(sending);
    for (std::size_t first = 0; first < pieces.size() && !lost;) {
        const ssize_t put =
            ::writev(out, &pieces[first], int(std::min<std::size_t>(pieces.size() - first, 64)));
        if (put < 0 && errno == EINTR) continue;
        if (put < 0 && errno == EAGAIN) {
            pollfd ready{out, POLLOUT, 0};
            ::poll(&ready, 1, -1);
            continue;
        }
        if (put < 0) lost = true;
        for (auto left = std::size_t(std::max<ssize_t>(put, 0)); left > 0 && first < pieces.size();) {
            const std::size_t count = std::min(left, pieces[first].iov_len);
            pieces[first].iov_base = static_cast<char*>(pieces[first].iov_base) + count;
            pieces[first].iov_len -= count, left -= count;
            if (pieces[first].iov_len == 0) ++first;
        }
    }
    return !lost;
}

}  // namespace fw::serve
