#include "io/bags/unpack.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <memory>

namespace ldso {
namespace {

/// That are unpacked at once. Memory is taken for what really comes out, not for what is announced.
constexpr std::size_t kPartBytes = 1 << 16;

/// How far one call has come.
struct Step {
  std::size_t taken = 0;  ///< Bytes of the input.
  std::size_t given = 0;  ///< Bytes of the output.
  bool is_done = false;
  std::string problem;
};

/// Calls `step(in, out)` until it is done, has nothing more to take and to give, or says a problem.
template <class StepFunction>
Unpacked unpack_by(std::span<const std::uint8_t> packed, std::size_t most, const StepFunction& step) {
  Unpacked result;
  std::vector<std::uint8_t> part(kPartBytes);
  while (true) {
    const Step made = step(packed, std::span(part));
    if (made.given > most - result.bytes.size()) {
      result.problem = "it is larger than announced";
      return result;
    }
    result.bytes.insert(result.bytes.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(made.given));
    packed = packed.subspan(made.taken);
    result.problem = made.problem;
    if (made.is_done || !made.problem.empty()) return result;
    if (made.taken == 0 && made.given == 0) {
      result.problem = "it is cut off";
      return result;
    }
  }
}

Unpacked unpack_lz4(std::span<const std::uint8_t> packed, std::size_t most) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(raw,
                                                                                     &LZ4F_freeDecompressionContext);
  return unpack_by(packed, most, [&](std::span<const std::uint8_t> in, std::span<std::uint8_t> out) {
    std::size_t taken = in.size(), given = out.size();
    const std::size_t left = LZ4F_decompress(context.get(), out.data(), &given, in.data(), &taken, nullptr);
    if (LZ4F_isError(left) != 0) return Step{0, 0, false, std::string("damaged LZ4 (") + LZ4F_getErrorName(left) + ")"};
    return Step{taken, given, left == 0, ""};
  });
}

Unpacked unpack_zstd(std::span<const std::uint8_t> packed, std::size_t most) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(), &ZSTD_freeDStream);
  if (!stream) throw std::bad_alloc();
  return unpack_by(packed, most, [&](std::span<const std::uint8_t> in, std::span<std::uint8_t> out) {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out.data(), out.size(), 0};
    const std::size_t left = ZSTD_decompressStream(stream.get(), &output, &input);
    if (ZSTD_isError(left) != 0) {
      return Step{0, 0, false, std::string("damaged Zstandard (") + ZSTD_getErrorName(left) + ")"};
    }
    return Step{input.pos, output.pos, left == 0, ""};
  });
}

Unpacked unpack_bz2(std::span<const std::uint8_t> packed, std::size_t most) {
  bz_stream state{};
  if (BZ2_bzDecompressInit(&state, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> stream(&state, &BZ2_bzDecompressEnd);
  return unpack_by(packed, most, [&](std::span<const std::uint8_t> in, std::span<std::uint8_t> out) {
    // The library only reads what it calls a mutable pointer.
    state.next_in = reinterpret_cast<char*>(const_cast<std::uint8_t*>(in.data()));
    state.avail_in = static_cast<unsigned>(std::min<std::size_t>(in.size(), 1U << 30U));
    state.next_out = reinterpret_cast<char*>(out.data());
    state.avail_out = static_cast<unsigned>(out.size());
    const unsigned before = state.avail_in;
    const int code = BZ2_bzDecompress(&state);
    const std::size_t given = out.size() - state.avail_out;
    if (code != BZ_OK && code != BZ_STREAM_END) return Step{0, given, false, "damaged bzip2"};
    return Step{before - state.avail_in, given, code == BZ_STREAM_END, ""};
  });
}

}  // namespace

std::optional<Packing> packing_of(const std::string& name) {
  if (name.empty() || name == "none") return Packing::kNone;
  if (name == "bz2") return Packing::kBz2;
  if (name == "lz4") return Packing::kLz4;
  if (name == "zstd") return Packing::kZstd;
  return std::nullopt;
}

Unpacked unpack(Packing packing, std::span<const std::uint8_t> packed, std::size_t most) {
  switch (packing) {
    case Packing::kBz2:
      return unpack_bz2(packed, most);
    case Packing::kLz4:
      return unpack_lz4(packed, most);
    case Packing::kZstd:
      return unpack_zstd(packed, most);
    default:
      const bool fits = packed.size() <= most;
      return {{packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(std::min(most, packed.size()))},
              fits ? "" : "it is larger than announced"};
  }
}

}  // namespace ldso
