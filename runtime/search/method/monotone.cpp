#include "runtime/search/method/monotone.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "runtime/search/method/draws.h"

namespace probe::search {
namespace {

constexpr int kMostDraws = 999, kEnoughExceedances = 20;

struct Tried {
  double k, n;
};

double largest_rise(const std::vector<Tried>& tried) {
  double largest = 0;
  for (std::size_t middle = 1; middle < tried.size(); ++middle) {
    double k1 = 0, n1 = 0;
    for (std::size_t first = middle; first-- > 0;) {
      k1 += tried[first].k;
      n1 += tried[first].n;
      double k2 = 0, n2 = 0;
      for (std::size_t last = middle; last < tried.size(); ++last) {
        k2 += tried[last].k;
        n2 += tried[last].n;
        const double rise = k2 * n1 - k1 * n2;
        if (rise <= 0) continue;
        const double k = k1 + k2, n = n1 + n2;
        // (p2 - p1)^2 / (p (1 - p) (1/n1 + 1/n2)), multiplied out.
        largest = std::max(largest, rise * rise * n / (n1 * n2 * k * (n - k)));
      }
    }
  }
  return largest;
}

// Rates that nowhere rise, in the order of `tried`.
std::vector<double> isotonic_rates(const std::vector<Tried>& tried) {
  struct Pool {
    double k, n;
    std::size_t size;
  };
  std::vector<Pool> pools;
  for (const Tried& one : tried) {
    pools.push_back({one.k, one.n, 1});
    while (pools.size() > 1) {
      const Pool last = pools.back();
      Pool& before = pools[pools.size() - 2];
      if (before.k * last.n >= last.k * before.n) break;
      before = {before.k + last.k, before.n + last.n, before.size + last.size};
      pools.pop_back();
    }
  }
  std::vector<double> rates;
  for (const Pool& pool : pools) {
    rates.insert(rates.end(), pool.size, (pool.k + 0.5) / (pool.n + 1));
  }
  return rates;
}

}  // namespace

double monotone_p(std::span<const stats::Count> successes, std::uint64_t seed) {
  std::vector<Tried> tried;
  for (const stats::Count& count : successes) {
    if (count.n > 0) tried.push_back({static_cast<double>(count.k), static_cast<double>(count.n)});
  }
  const double seen = largest_rise(tried);
  if (seen == 0) return 1;
  const std::vector<double> rates = isotonic_rates(tried);
  Draws draws(seed, "monotone");
  std::vector<Tried> drawn = tried;
  int exceedances = 0;
  for (int draw = 1; draw <= kMostDraws; ++draw) {
    for (std::size_t i = 0; i < tried.size(); ++i) {
      drawn[i].k = 0;
      for (int j = 0; j < static_cast<int>(tried[i].n); ++j) {
        drawn[i].k += draws.uniform() < rates[i] ? 1 : 0;
      }
    }
    exceedances += largest_rise(drawn) >= seen * (1 - 1e-9) ? 1 : 0;
    if (exceedances == kEnoughExceedances) return exceedances / static_cast<double>(draw);
  }
  return (exceedances + 1) / (kMostDraws + 1.0);
}

}  // namespace probe::search
