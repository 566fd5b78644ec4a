#include "mapping/map/chain_table.h"

#include <cstddef>

namespace ldso {
namespace {

using Covariances = decltype(OdometryChain::covariance);

/// Of A x, from those of x.
Covariances carried(const Matrix7d& A, Covariances covariances) {
  for (Matrix7d& C : covariances) C = (A * C * A.transpose()).eval();
  return covariances;
}

/// The way from b to a, from that from a to b.
OdometryChain reversed(const OdometryChain& chain) {
  OdometryChain result;
  result.S_from_to = chain.S_from_to.inverse();
  result.covariance = carried(result.S_from_to.adjoint(), chain.covariance);
  result.length = chain.length;
  result.breaks = chain.breaks;
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
      chain.S_from_to = before.S_from_to * step.S_from_to;
      chain.covariance = carried(before.S_from_to.adjoint(), step.covariance);
      for (std::size_t k = 0; k < chain.covariance.size(); ++k) chain.covariance[k] += before.covariance[k];
      chain.length = before.length + step.length;
      chain.breaks = before.breaks + step.breaks;
    }
    last = index;
  }
}

OdometryChain ChainTable::between(int from, int to) const {
  const OdometryChain& a = from_first_[static_cast<std::size_t>(from)];
  const OdometryChain& b = from_first_[static_cast<std::size_t>(to)];
  if (a.length > b.length) return reversed(between(to, from));
  const Sim3d S_from_first = a.S_from_to.inverse();
  OdometryChain chain;
  chain.S_from_to = S_from_first * b.S_from_to;
  for (std::size_t k = 0; k < chain.covariance.size(); ++k) chain.covariance[k] = b.covariance[k] - a.covariance[k];
  chain.covariance = carried(S_from_first.adjoint(), chain.covariance);
  chain.length = b.length - a.length;
  chain.breaks = b.breaks - a.breaks;
  return chain;
}

}  // namespace ldso
