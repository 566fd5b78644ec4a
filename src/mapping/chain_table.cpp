#include "mapping/chain_table.h"

#include <cmath>
#include <cstddef>

namespace ldso {
namespace {

/// The way from b to a, from that from a to b.
OdometryChain reversed(const OdometryChain& chain) {
  OdometryChain result;
  result.S_from_to = chain.S_from_to.inverse();
  const Matrix7d A = result.S_from_to.adjoint();
  for (std::size_t k = 0; k < chain.covariance.size(); ++k) {
    result.covariance[k] = A * chain.covariance[k] * A.transpose();
  }
  result.length = chain.length;
  return result;
}

}  // namespace

ChainTable::ChainTable(const KeyframeMap& map) : from_first_(static_cast<std::size_t>(map.size())) {
  int last = -1;
  for (const int index : map.in_time()) {
    OdometryChain& chain = from_first_[static_cast<std::size_t>(index)];
    if (last < 0) {
      chain.covariance.fill(Matrix7d::Zero());
    } else {
      const OdometryChain& before = from_first_[static_cast<std::size_t>(last)];
      const OdometryChain step = map.chain(last, index);
      const Matrix7d A = before.S_from_to.adjoint();
      chain.S_from_to = before.S_from_to * step.S_from_to;
      for (std::size_t k = 0; k < step.covariance.size(); ++k) {
        chain.covariance[k] = before.covariance[k] + A * step.covariance[k] * A.transpose();
      }
      chain.length = before.length + step.length;
    }
    last = index;
  }
}

OdometryChain ChainTable::between(int from, int to) const {
  const OdometryChain& a = from_first_[static_cast<std::size_t>(from)];
  const OdometryChain& b = from_first_[static_cast<std::size_t>(to)];
  if (a.length > b.length) return reversed(between(to, from));
  const Sim3d S_from_first = a.S_from_to.inverse();
  const Matrix7d A = S_from_first.adjoint();
  OdometryChain chain;
  chain.S_from_to = S_from_first * b.S_from_to;
  for (std::size_t k = 0; k < chain.covariance.size(); ++k) {
    chain.covariance[k] = A * (b.covariance[k] - a.covariance[k]) * A.transpose();
  }
  chain.length = b.length - a.length;
  return chain;
}

}  // namespace ldso
