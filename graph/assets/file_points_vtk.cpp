// Legacy VTK ("VTK File Formats for VTK Version 4.2", Kitware): a line of the version, a title, ASCII or
// BINARY, then arrays behind lines of keywords, whose binary numbers have their high byte first. Cells are
// passed over; so is what follows a keyword that is not known, once there are points.
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>

#include "graph/assets/file_points.h"
#include "graph/assets/triangle_mesh_text.h"
#include "graph/base/file_kind.h"

namespace fw {

namespace {

struct VtkFault {
    std::string what;
};
[[noreturn]] void failVtk(const std::string& what) { throw VtkFault{what}; }

enum class VtkType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };
constexpr std::pair<std::string_view, VtkType> kVtkTypes[] = {{"char", VtkType::int8},
                                                              {"unsigned_char", VtkType::uint8},
                                                              {"short", VtkType::int16},
                                                              {"unsigned_short", VtkType::uint16},
                                                              {"int", VtkType::int32},
                                                              {"unsigned_int", VtkType::uint32},
                                                              {"long", VtkType::int64},
                                                              {"unsigned_long", VtkType::uint64},
                                                              {"vtkidtype", VtkType::int64},
                                                              {"vtktypeint64", VtkType::int64},
                                                              {"vtktypeuint64", VtkType::uint64},
                                                              {"vtktypeint32", VtkType::int32},
                                                              {"vtktypeuint32", VtkType::uint32},
                                                              {"float", VtkType::float32},
                                                              {"double", VtkType::float64}};

std::string lowered(std::string_view word) {
    std::string made(word);
    for (char& c : made) c = char(std::tolower(static_cast<unsigned char>(c)));
    return made;
}

class VtkReader {
  public:
    explicit VtkReader(std::string_view bytes) : scanner{bytes} {}

    FilePoints run() {
        if (!scanner.line().starts_with("# vtk DataFile Version")) failVtk("is no legacy VTK file");
        scanner.line();
        const std::string form = lowered(Scanner{scanner.line()}.word());
        if (form != "ascii" && form != "binary") failVtk("tells neither ASCII nor BINARY");
        binary = form == "binary";
        while (!scanner.atEnd()) {
            Scanner words{scanner.line()};
            const std::string word = lowered(words.word());
            if (word.empty()) continue;
            if (!section(word, words)) break;
        }
        if (!found) failVtk("has no POINTS");
        return std::move(points);
    }

  private:
    std::size_t countIn(Scanner& words) {
        const auto count = words.number<uint64_t>();
        if (!count) failVtk("has a section without a count");
        if (*count > scanner.rest.size()) failVtk("is cut off: copy it again");
        return std::size_t(*count);
    }

    static VtkType typeIn(Scanner& words) {
        const std::string name = lowered(words.word());
        for (const auto& [known, type] : kVtkTypes)
            if (known == name) return type;
        failVtk("has numbers of type " + inQuotes(name) + ", which is not read");
    }

    template <class T>
    double big() {
        const std::optional<T> value = scanner.raw<T>();
        if (!value) failVtk("is cut off: copy it again");
        auto bytes = std::bit_cast<std::array<unsigned char, sizeof(T)>>(*value);
        std::ranges::reverse(bytes);
        return double(std::bit_cast<T>(bytes));
    }

    double number(VtkType type) {
        if (!binary) {
            const std::string_view word = scanner.word();
            if (word.empty()) failVtk("is cut off: copy it again");
            const auto value = Scanner::numberIn<double>(word);
            if (!value) failVtk("has " + inQuotes(std::string(word)) + " where a number should be");
            return *value;
        }
        switch (type) {
            case VtkType::int8: return big<int8_t>();
            case VtkType::uint8: return big<uint8_t>();
            case VtkType::int16: return big<int16_t>();
            case VtkType::uint16: return big<uint16_t>();
            case VtkType::int32: return big<int32_t>();
            case VtkType::uint32: return big<uint32_t>();
            case VtkType::int64: return big<int64_t>();
            case VtkType::uint64: return big<uint64_t>();
            case VtkType::float32: return big<float>();
            case VtkType::float64: return big<double>();
        }
        return 0.0;
    }

    void skip(std::size_t count, VtkType type) {
        for (std::size_t i = 0; i < count; ++i) number(type);
    }

    void vectors(std::vector<glm::vec3>& list, std::size_t count, VtkType type) {
        list.clear();
        for (std::size_t i = 0; i < count; ++i) {
            glm::vec3& each = list.emplace_back();
            for (int k = 0; k < 3; ++k) each[k] = float(number(type));
        }
    }

    void ids(std::size_t count, VtkType type) {
        points.ids.clear();
        for (std::size_t i = 0; i < count; ++i) {
            const double id = number(type);
            if (!(id >= -2147483648.0 && id <= 4294967295.0))
                failVtk("has an id that is no whole number of 32 bits");
            points.ids.push_back(uint32_t(int64_t(id)));
        }
    }

    /// An array of so many numbers for each point.
    void array(const std::string& name, std::size_t components, std::size_t tuples, VtkType type) {
        const bool ofPoints = found && tuples == points.places.size() && pointData;
        if (ofPoints && components == 3 && namesVelocity(name))
            vectors(points.velocities, tuples, type);
        else if (ofPoints && components == 1 && namesId(name))
            ids(tuples, type);
        else
            skip(components * tuples, type);
    }

    /// Reads what follows a keyword; false of one that is not known.
    bool section(const std::string& word, Scanner& words) {
        if (word == "dataset" || word == "dimensions" || word == "origin" || word == "spacing" ||
            word == "lookup_table")
            return word != "lookup_table";
        if (word == "points") {
            if (found) failVtk("has POINTS twice: keep one");
            const std::size_t count = countIn(words);
            if (count > kMostFileParticles)
                failVtk("has " + std::to_string(count) + " particles: " + std::to_string(kMostFileParticles) +
                        " is the most");
            vectors(points.places, count, typeIn(words));
            return found = true;
        }
        if (word == "vertices" || word == "lines" || word == "polygons" || word == "triangle_strips" ||
            word == "cells") {
            offsets = countIn(words), connections = countIn(words);
            // Version 5 has both in arrays of their own.
            Scanner ahead = scanner;
            Scanner next{ahead.line()};
            if (lowered(next.word()) != "offsets") skip(connections, VtkType::int32);
            return true;
        }
        if (word == "offsets" || word == "connectivity")
            return skip(word == "offsets" ? offsets : connections, typeIn(words)), true;
        if (word == "cell_types") return skip(countIn(words), VtkType::int32), true;
        if (word == "point_data" || word == "cell_data") {
            dataCount = countIn(words);
            pointData = word == "point_data";
            return true;
        }
        if (word == "vectors" || word == "normals") {
            const std::string name(words.word());
            array(name, 3, dataCount, typeIn(words));
            return true;
        }
        if (word == "scalars") {
            const std::string name(words.word());
            const VtkType type = typeIn(words);
            const std::size_t components = words.number<uint32_t>().value_or(1);
            if (components < 1 || components > 4) failVtk("has scalars of an impossible size");
            scanner.line();  // of the lookup table
            array(name, components, dataCount, type);
            return true;
        }
        if (word == "field") {
            words.word();
            const std::size_t arrays = countIn(words);
            for (std::size_t i = 0; i < arrays; ++i) {
                Scanner line{scanner.line()};
                while (!scanner.atEnd() && Scanner{line}.word().empty()) line = Scanner{scanner.line()};
                const std::string name(line.word());
                const std::size_t components = countIn(line), tuples = countIn(line);
                if (components > 0 && tuples > scanner.rest.size() / components)
                    failVtk("is cut off: copy it again");
                array(name, components, tuples, typeIn(line));
            }
            return true;
        }
        return false;
    }

    Scanner scanner;
    bool binary = false, found = false, pointData = false;
    std::size_t dataCount = 0, offsets = 0, connections = 0;
    FilePoints points;
};

}  // namespace

bool namesVelocity(std::string_view name) {
    const std::string word = lowered(name);
    return word == "velocity" || word == "velocities" || word == "vel" || word == "v";
}

bool namesId(std::string_view name) {
    const std::string word = lowered(name);
    return word == "id" || word == "ids" || word == "particle_id" || word == "particleid";
}

Result<FilePoints> readVtkPoints(std::string_view bytes, const std::string& path) {
    try {
        return VtkReader(bytes).run();
    } catch (const VtkFault& fault) { return fileProblem(path, kParticleFile, fault.what); }
}

}  // namespace fw
