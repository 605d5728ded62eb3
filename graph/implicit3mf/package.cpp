#include "graph/implicit3mf/package.h"

#include <zip.h>

#include <cassert>
#include <ctime>

namespace fw::threemf {

namespace {

constexpr std::time_t kPackedAt = 315532800;  // 1980-01-01, the first day that an archive knows

/// OPC names begin with a slash, an archive's do not.
const char* inArchive(const std::string& name) { return name.c_str() + (name.starts_with('/') ? 1 : 0); }

std::string inMegabytes(std::size_t bytes) { return std::to_string(bytes >> 20) + " MB"; }

}  // namespace

void Package::Discard::operator()(zip* archive) const { zip_discard(archive); }

Result<Package> Package::open(const std::string& bytes) {
    if (bytes.empty()) return Error{.message = "is an empty file"};
    if (!bytes.starts_with("PK")) return Error{.message = "is no 3MF file: it is no ZIP archive"};
    Package package;
    package.bytes = std::make_shared<const std::string>(bytes);
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source = zip_source_buffer_create(package.bytes->data(), package.bytes->size(), 0, &error);
    package.archive.reset(source ? zip_open_from_source(source, ZIP_RDONLY, &error) : nullptr);
    if (!package.archive && source) zip_source_free(source);
    const std::string reason = zip_error_strerror(&error);
    zip_error_fini(&error);
    if (!package.archive)
        return Error{.message = "is damaged or cut off (" + reason + "): save or copy it again"};
    return package;
}

bool Package::has(const std::string& name) const {
    return zip_name_locate(archive.get(), inArchive(name), ZIP_FL_NOCASE) >= 0;
}

Result<std::string> Package::part(const std::string& name, std::size_t most) const {
    const auto problem = [&](const std::string& what) {
        return Error{.message = "the part " + inQuotes(name) + " " + what};
    };
    const zip_int64_t at = zip_name_locate(archive.get(), inArchive(name), ZIP_FL_NOCASE);
    if (at < 0) return problem("is not in it");
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(
        zip_fopen_index(archive.get(), static_cast<zip_uint64_t>(at), 0), zip_fclose);
    if (!file) return problem("cannot be unpacked: " + std::string(zip_strerror(archive.get())));
    std::string content;
    for (std::size_t step = 1u << 16;; step = std::min<std::size_t>(2 * step, 4u << 20)) {
        const std::size_t size = content.size();
        content.resize(size + step);
        const zip_int64_t count = zip_fread(file.get(), content.data() + size, step);
        if (count < 0)
            return problem("is damaged (" + std::string(zip_file_strerror(file.get())) +
                           "): save or copy the file again");
        content.resize(size + static_cast<std::size_t>(count));
        if (content.size() > most)
            return problem("unpacks to more than " + inMegabytes(most) + ", which is not read");
        if (count == 0) return content;
    }
}

std::string packed(const std::vector<Part>& parts) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* target = zip_source_buffer_create(nullptr, 0, 0, &error);
    zip_t* archive = target ? zip_open_from_source(target, ZIP_CREATE | ZIP_TRUNCATE, &error) : nullptr;
    if (!archive) throw std::bad_alloc();  // in memory nothing else fails
    zip_source_keep(target);
    for (const Part& part : parts) {
        zip_source_t* content = zip_source_buffer(archive, part.bytes.data(), part.bytes.size(), 0);
        const zip_int64_t at = zip_file_add(archive, inArchive(part.name), content, ZIP_FL_ENC_UTF_8);
        if (!content || at < 0) throw std::bad_alloc();
        zip_file_set_mtime(archive, static_cast<zip_uint64_t>(at), kPackedAt, 0);
    }
    std::string bytes;
    if (zip_close(archive) != 0 || zip_source_open(target) != 0) throw std::bad_alloc();
    zip_source_seek(target, 0, SEEK_END);
    bytes.resize(static_cast<std::size_t>(zip_source_tell(target)));
    zip_source_seek(target, 0, SEEK_SET);
    const zip_int64_t count = zip_source_read(target, bytes.data(), bytes.size());
    assert(count == static_cast<zip_int64_t>(bytes.size()));
    (void)count;
    zip_source_close(target);
    zip_source_free(target);
    zip_error_fini(&error);
    return bytes;
}

}  // namespace fw::threemf
