#pragma once

// Idea: a fuzz target hands arbitrary bytes to one parser. The parser may take them or refuse them with ldso::Error;
// what else can happen (another exception, a crash, an endless loop, memory taken on the word of a header, numbers that
// are none) ends the program and so is found. One file per target, called as the target.
//
// A target is built twice: by Clang with libFuzzer (preset `fuzz`), and into the test `fuzz_replay`, which gives all
// targets their seeds, among them everything that was ever found.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "ldso/error.h"

namespace ldso::fuzz {

using Target = void (*)(std::string_view input);

/// Makes a target known to `fuzz_replay`.
struct Registration {
  Registration(const char* name, Target target);
};

/// Ends the program with `what` if that does not hold.
void expect(bool holds, const char* what);

/// Also if there are none.
bool all_finite(std::initializer_list<double> values);

/// What `parse` returns; nothing if it refused with an Error, which has to say something.
template <class Parse>
auto accepted(const Parse& parse) -> std::optional<decltype(parse())> {
  try {
    return parse();
  } catch (const Error& error) {
    expect(!std::string_view(error.what()).empty(), "an error says nothing");
    return std::nullopt;
  }
}

/// Whether `action`, which returns nothing, was not refused with an Error.
template <class Action>
bool succeeds(const Action& action) {
  return accepted([&] { return action(), true; }).has_value();
}

/// A folder in memory (where the system has one), one for this process, removed at its end.
const std::filesystem::path& scratch_folder();

/// Writes the bytes to a file there and returns its path; for parsers that want one.
std::filesystem::path scratch_file(const std::string& name, std::string_view content);

/// The two parts of an input: up to the first line break and after it.
std::pair<std::string_view, std::string_view> split_line(std::string_view input);

}  // namespace ldso::fuzz

#ifdef LDSO_FUZZER
#define LDSO_FUZZ_TARGET(name)                                                        \
  static void fuzz_##name(std::string_view input);                                    \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { \
    fuzz_##name({reinterpret_cast<const char*>(data), size});                         \
    return 0;                                                                         \
  }                                                                                   \
  static void fuzz_##name(std::string_view input)
#else
#define LDSO_FUZZ_TARGET(name)                                                   \
  static void fuzz_##name(std::string_view input);                               \
  static const ldso::fuzz::Registration registration_##name(#name, fuzz_##name); \
  static void fuzz_##name(std::string_view input)
#endif
