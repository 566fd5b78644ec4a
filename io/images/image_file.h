#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ldso/image.h"
#include "ldso/rgb.h"

namespace ldso {

// Image files to and from plain buffers. The codecs are OpenCV's and stay inside the .cpp file.

/// Decodes PNG, JPEG, PGM, TIFF, BMP, ... to grey levels in 0..255: 8-bit values exactly, 16-bit values divided by 257,
/// colour by the BT.601 weights (0.299, 0.587, 0.114). Rows are those of the file, whatever EXIF asks viewers to turn.
/// `name` is what messages call the image. Throws Error if the data are truncated or no image of 8 or 16 bit. Of 16-bit
/// images whose camera has fewer bits, `bits` says how many are used: 2^bits - 1 becomes 255.
Image<float> decode_grey_image(std::span<const std::uint8_t> bytes, const std::string& name, int bits = 16);

/// The same in colour, 8 bit a channel; grey images have three equal channels.
Image<Rgb> decode_color_image(std::span<const std::uint8_t> bytes, const std::string& name, int bits = 16);

/// The largest value of an image of 16 bits a channel; nothing of one of 8 bits. Throws Error as decode_grey_image().
std::optional<int> largest_16_bit_value(std::span<const std::uint8_t> bytes, const std::string& name);

/// decode_grey_image() of a file.
Image<float> read_grey_image(const std::filesystem::path& path);

/// Vignette: grey image of 8 or 16 bit, divided by its maximum. Black pixels are raised to 1e-3, so that dividing by
/// the vignette stays finite. Throws Error if it cannot be read or is black all over.
Image<float> read_vignette(const std::filesystem::path& path);

/// Values are rounded and clamped to 0..255.
void write_grey_png(const std::filesystem::path& path, ImageView<const float> grey);
/// The bytes of a JPEG file; values are rounded and clamped to 0..255, `quality` is 0..100.
std::vector<std::uint8_t> encode_grey_jpeg(ImageView<const float> grey, int quality);
/// Values 0..255 become 0..65535 (times 257, rounded, clamped): read_grey_image() gives them back.
std::vector<std::uint8_t> encode_jpeg(ImageView<const Rgb> image, int quality);
void write_grey16_png(const std::filesystem::path& path, ImageView<const float> grey);
/// Values as they are, depth maps in millimetres for instance.
void write_png(const std::filesystem::path& path, ImageView<const std::uint16_t> image);
void write_png(const std::filesystem::path& path, ImageView<const Rgb> image);

/// Whether a file name ends as an image that can be read.
bool has_image_extension(const std::filesystem::path& path);

/// Whole content of a file. Throws Error if it cannot be read.
std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path);

}  // namespace ldso
