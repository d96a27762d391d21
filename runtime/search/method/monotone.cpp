#include "runtime/search/method/monotone.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "runtime/search/method/draws.h"

namespace probe::search {
namespace {

constexpr int kMostDraws = 999, kEnoughExceedances = 20;

struct Tried {
  std::size_t k, n;
};

// x log x of whole numbers.
class Entropies {
 public:
  explicit Entropies(std::size_t most) : values_(most + 1) {
    for (std::size_t x = 2; x <= most; ++x) {
      values_[x] = static_cast<double>(x) * std::log(static_cast<double>(x));
    }
  }
  // The log likelihood of k of n at its own rate.
  double operator()(std::size_t k, std::size_t n) const {
    return values_[k] + values_[n - k] - values_[n];
  }

 private:
  std::vector<double> values_;
};

// Or some rise of `enough` or more.
double largest_rise(const std::vector<Tried>& tried, const Entropies& likelihood,
                    double enough = 1e300) {
  double largest = 0;
  for (std::size_t middle = 1; middle < tried.size(); ++middle) {
    std::size_t k1 = 0, n1 = 0;
    for (std::size_t first = middle; first-- > 0;) {
      k1 += tried[first].k;
      n1 += tried[first].n;
      const double before = likelihood(k1, n1);
      std::size_t k2 = 0, n2 = 0;
      for (std::size_t last = middle; last < tried.size(); ++last) {
        k2 += tried[last].k;
        n2 += tried[last].n;
        if (k2 * n1 <= k1 * n2) continue;
        const double ratio = before + likelihood(k2, n2) - likelihood(k1 + k2, n1 + n2);
        largest = std::max(largest, ratio);
        if (largest >= enough) return largest;
      }
    }
  }
  return largest;
}

// Rates that nowhere rise, in the order of `tried`.
std::vector<double> isotonic_rates(const std::vector<Tried>& tried) {
  struct Pool {
    std::size_t k, n, size;
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
    rates.insert(rates.end(), pool.size,
                 (static_cast<double>(pool.k) + 0.5) / (static_cast<double>(pool.n) + 1));
  }
  return rates;
}

}  // namespace

double monotone_p(std::span<const stats::Count> successes, std::uint64_t seed) {
  std::vector<Tried> tried;
  std::size_t all = 0;
  for (const stats::Count& count : successes) {
    if (count.n > 0)
      tried.push_back({static_cast<std::size_t>(count.k), static_cast<std::size_t>(count.n)});
  }
  for (const Tried& one : tried) all += one.n;
  const Entropies likelihood(all);
  const double seen = largest_rise(tried, likelihood);
  if (seen == 0) return 1;
  const std::vector<double> rates = isotonic_rates(tried);
  Draws draws(seed, "monotone");
  std::vector<Tried> drawn = tried;
  int exceedances = 0;
  for (int draw = 1; draw <= kMostDraws; ++draw) {
    for (std::size_t i = 0; i < tried.size(); ++i) {
      drawn[i].k = 0;
      for (std::size_t j = 0; j < tried[i].n; ++j) {
        drawn[i].k += draws.uniform() < rates[i] ? 1U : 0U;
      }
    }
    const double enough = seen * (1 - 1e-9);
    exceedances += largest_rise(drawn, likelihood, enough) >= enough ? 1 : 0;
    if (exceedances == kEnoughExceedances) return exceedances / static_cast<double>(draw);
  }
  return (exceedances + 1) / (kMostDraws + 1.0);
}

}  // namespace probe::search
