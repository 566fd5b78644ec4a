#pragma once

// Vocabularies as files. Own format, all numbers little-endian:
//
//   "ldsovoc\0"; version (u32, 1); nodes, words, length of the origin (u32 each); the origin;
//   number of children of each node (u8), level after level, the root first;
//   descriptors of all nodes but the root (32 bytes each); weights of the words (f32);
//   FNV-1a (64 bit) of everything before.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "place/vocabulary.h"

namespace ldso {

/// What own files begin with.
inline constexpr std::string_view kVocabularyMagic{"ldsovoc\0", 8};

/// Own files and those of DBoW (dbow_vocabulary_file.h), recognized by their content. Throws Error naming the file if
/// it cannot be read, is of no known format, of a newer version, or damaged.
Vocabulary read_vocabulary(const std::filesystem::path& path);

/// The same for a file in memory; `name` is what messages call it.
Vocabulary parse_vocabulary(std::span<const std::uint8_t> bytes, const std::string& name);

/// Own format. Throws Error if a node has more than 255 children.
std::vector<std::uint8_t> vocabulary_bytes(const Vocabulary& vocabulary);

/// Writes vocabulary_bytes() beside `path` first and renames it. Throws Error if it cannot be written.
void write_vocabulary(const std::filesystem::path& path, const Vocabulary& vocabulary);

}  // namespace ldso
