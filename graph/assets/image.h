// Pictures that a graph's nodes sample: decoded once, read as functions of (u, v).
//
// A field image is a grid of texels that repeats over the plane, one period a unit of u and of v; u goes to
// the right and v upwards, (0, 0) being the lower left corner of the picture. Between the centres of texels
// values are bilinear. Each texel is one word: red, green and blue as the file has them (sRGB, 8 bits each),
// and in the fourth byte their mean. A *layer* is one of four functions: red, green, blue as linear light
// (0 to 1), and the grey as stored (0 to 1, no curve: a height is a number, not a light). Transparency is
// ignored.
//
// The double functions here are the reference of shaders/lib/image.glsl, which reads the same words.
//
// Lifetime: images are shared and never change; an Ir keeps those that its operations sample. A file that
// has not changed since it was last read is not read again while any graph holds its image.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "graph/base/interval.h"
#include "graph/base/result.h"

namespace fw {

inline constexpr int kMaxImageSide = 4096;                 ///< texels
inline constexpr std::size_t kMaxImageBytes = 128u << 20;  ///< all images of a graph take less, decoded

inline constexpr int kImageLayers = 4;
inline constexpr int kGreyLayer = 3;

struct FieldImage;

/// Linear light, 0 to 1, of an sRGB code, 0 to 1 (IEC 61966-2-1).
double decodeSrgb(double code);
/// Its inverse: the code of linear light.
double encodeSrgb(double linear);

/// One function of (u, v), with what bounds it.
struct ImageLayer {
    const FieldImage* image = nullptr;
    int channel = 0;                    ///< 0, 1, 2: linear light; kGreyLayer: as stored
    double least = 0.0, most = 1.0;     ///< over the whole image
    double slopeU = 0.0, slopeV = 0.0;  ///< greatest |d/du|, |d/dv|
};

/// A sample and its partial derivatives.
struct ImageSample {
    double value, du, dv;
};

struct FieldImage {
    /// `texels` are width x height words, the picture's lowest row first; the fourth byte is filled in here.
    FieldImage(int width, int height, std::vector<uint32_t> texels, std::string file = {});
    FieldImage(const FieldImage&) = delete;  // layers point here
    FieldImage& operator=(const FieldImage&) = delete;

    int width, height;
    std::vector<uint32_t> texels;
    std::string file;  ///< absolute path; empty if it was not read from one
    uint64_t hash;     ///< of size and content
    std::array<ImageLayer, kImageLayers> layers;
};
using FieldImagePtr = std::shared_ptr<const FieldImage>;

ImageSample sampleImage(const ImageLayer& layer, double u, double v);
/// Contains every sample with u and v in the intervals.
Interval sampleImage(const ImageLayer& layer, Interval u, Interval v);

/// A byte of an sRGB picture as linear light, 0 to 1.
double linearOfByte(int byte);

/// The words of all images, one after the other: what the device reads. Never empty.
std::vector<uint32_t> imageWords(const std::vector<FieldImagePtr>& images);

/// The image of an input that names no file: a grey checker of two by two squares.
const FieldImagePtr& plainImage();

/// Reads a file of the kind kPictureFile (file_kind.h). `path` is relative to the folder of the file
/// `graphPath` (to the current folder if that is empty), and must lead to a file inside that folder's tree.
/// The Error has a message only: the path is no such file, cannot be read or leads out of the folder; the
/// file is no picture, is damaged or larger than the limits.
Result<FieldImagePtr> readImage(const std::string& graphPath, const std::string& path);

}  // namespace fw
