#pragma once

// Vocabularies that others have trained, in the two layouts that are in use for ORB descriptors. What is taken from
// them is the tree and the weights of the words; scoring is always that of score() and weighting tf-idf.
//
// DBoW2's text (as ORB-SLAM ships it): a line `k L scoring weighting`, then for each node a line `parent is_leaf b0 ..
// b31 weight`. Nodes count from 1 in the order of the lines; the root, 0, has none.
//
// DBoW3's binary, little-endian: signature 88877711233 (u64), compressed (u8), nodes with the root (u32); then k, L,
// scoring, weighting (i32 each); for each node but the root its number and its parent's (u32), weight (f64), columns,
// rows and OpenCV type of the descriptor (i32 each), its bytes; number of words (u32), word and node (u32) of each.

#include <cstdint>
#include <span>
#include <string>

#include "place/vocabulary.h"

namespace ldso {

bool is_dbow3_binary(std::span<const std::uint8_t> bytes);
/// Throws Error if the file is compressed, holds no 256-bit descriptors or is damaged.
Vocabulary parse_dbow3_binary(std::span<const std::uint8_t> bytes, const std::string& name);

/// Whether the first line is four whole numbers.
bool is_dbow2_text(std::span<const std::uint8_t> bytes);
/// Throws Error naming the line.
Vocabulary parse_dbow2_text(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace ldso
