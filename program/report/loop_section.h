#pragma once
// What loop closing found: the loops with their figures and pictures, and why the others were refused.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "ldso/records.h"
#include "results/loop_pictures.h"

namespace ldso {

/// Loops of which a report shows pictures: at most `most` of those that were accepted, evenly spread over the run.
std::vector<std::size_t> loops_to_show(std::span<const LoopRecord> loops, std::size_t most);

/// Says so if no pair of keyframes ever looked alike.
std::string loop_section(std::span<const LoopRecord> loops, const LoopPictures& pictures);

/// Reasons of refusal and how often each of them was given, most frequent first.
std::string refusal_table(std::span<const LoopRecord> loops);

}  // namespace ldso
