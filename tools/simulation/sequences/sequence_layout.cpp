#include "simulation/sequences/sequence_layout.h"

#include <algorithm>

namespace ldso::simulation {

std::string numbered(int index, int digits) {
  const std::string number = std::to_string(index);
  const std::size_t zeros = static_cast<std::size_t>(digits) - std::min<std::size_t>(digits, number.size());
  return std::string(zeros, '0').append(number);
}

}  // namespace ldso::simulation
