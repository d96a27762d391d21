#include "runtime/export/dataset/statistics.h"

#include <algorithm>
#include <cmath>

namespace probe::dataset {
namespace {

// Between the two of `count` values in order that are nearest to the quantile; `at` gives the i-th.
template <typename At>
double quantile(std::size_t count, double share, At at) {
  const double place = share * static_cast<double>(count - 1);
  const auto below = static_cast<std::size_t>(place);
  const double low = at(below), high = at(std::min(below + 1, count - 1));
  return low + (high - low) * (place - static_cast<double>(below));
}

void resize_all(Statistics& statistics, std::size_t size) {
  for (auto& values : statistics.values) values.assign(size, 0);
}

}  // namespace

Statistics statistics_of(std::span<const double> rows, std::size_t size) {
  const std::size_t count = rows.size() / size;
  Statistics out;
  resize_all(out, size);
  out.count = static_cast<std::int64_t>(count);
  std::vector<double> column(count);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t row = 0; row < count; ++row) column[row] = rows[row * size + i];
    double sum = 0, squares = 0;
    for (const double value : column) sum += value;
    const double mean = sum / static_cast<double>(count);
    for (const double value : column) squares += (value - mean) * (value - mean);
    std::ranges::sort(column);
    out.values[kMin][i] = column.front();
    out.values[kMax][i] = column.back();
    // Rounding must not put the mean of equal numbers beside them.
    out.values[kMean][i] = std::clamp(mean, column.front(), column.back());
    out.values[kStd][i] = std::sqrt(squares / static_cast<double>(count));
    for (std::size_t q = 0; q < kQuantiles.size(); ++q) {
      out.values[kFirstQuantile + q][i] =
          quantile(count, kQuantiles[q], [&](std::size_t at) { return column[at]; });
    }
  }
  return out;
}

void PictureStatistics::add(std::span<const std::uint8_t> rgb, int width, int height) {
  const int larger = std::max(width, height);
  const auto stride = static_cast<std::size_t>(larger < 300 ? 1 : larger / 150);
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  for (std::size_t y = 0; y < rows; y += stride) {
    for (std::size_t x = 0; x < columns; x += stride) {
      const std::uint8_t* pixel = rgb.data() + 3 * (y * columns + x);
      for (std::size_t channel = 0; channel < 3; ++channel) ++counts_[channel][pixel[channel]];
    }
  }
  ++frames_;
}

Statistics PictureStatistics::finish() const {
  Statistics out;
  resize_all(out, 3);
  out.count = frames_;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const auto& counts = counts_[channel];
    std::uint64_t count = 0, sum = 0, squares = 0;
    std::size_t least = 255, greatest = 0;
    for (std::size_t value = 0; value < counts.size(); ++value) {
      if (counts[value] == 0) continue;
      least = std::min(least, value);
      greatest = value;
      count += counts[value];
      sum += counts[value] * value;
      squares += counts[value] * value * value;
    }
    const auto n = static_cast<double>(count);
    const double mean = static_cast<double>(sum) / n;
    const double variance = static_cast<double>(squares) / n - mean * mean;
    const auto at = [&](std::size_t place) {
      std::uint64_t passed = 0;
      for (std::size_t value = 0; value < counts.size(); ++value) {
        passed += counts[value];
        if (place < passed) return static_cast<double>(value);
      }
      return 255.0;
    };
    out.values[kMin][channel] = static_cast<double>(least) / 255;
    out.values[kMax][channel] = static_cast<double>(greatest) / 255;
    out.values[kMean][channel] = mean / 255;
    out.values[kStd][channel] = std::sqrt(std::max(variance, 0.0)) / 255;
    for (std::size_t q = 0; q < kQuantiles.size(); ++q) {
      out.values[kFirstQuantile + q][channel] =
          quantile(static_cast<std::size_t>(count), kQuantiles[q], at) / 255;
    }
  }
  return out;
}

std::vector<std::size_t> sampled_frames(std::size_t count) {
  // The power by roots, which are exact everywhere.
  const double power =
      std::sqrt(static_cast<double>(count)) * std::sqrt(std::sqrt(static_cast<double>(count)));
  const std::size_t wanted = std::min(
      count,
      std::max<std::size_t>(100, std::min<std::size_t>(static_cast<std::size_t>(power), 10'000)));
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < wanted; ++i) {
    const double place = wanted == 1 ? 0.0
                                     : static_cast<double>(i) * static_cast<double>(count - 1) /
                                           static_cast<double>(wanted - 1);
    frames.push_back(static_cast<std::size_t>(std::nearbyint(place)));
  }
  return frames;
}

void StatisticsSum::add(const Statistics& part) {
  if (total_.count == 0) {
    total_ = part;
    return;
  }
  const auto before = static_cast<double>(total_.count), more = static_cast<double>(part.count);
  const double all = before + more;
  for (std::size_t i = 0; i < total_.values[kMean].size(); ++i) {
    const auto of = [&](std::size_t which) -> double& { return total_.values[which][i]; };
    const auto of_part = [&](std::size_t which) { return part.values[which][i]; };
    const double apart = of_part(kMean) - of(kMean);
    const double variance =
        (before * of(kStd) * of(kStd) + more * of_part(kStd) * of_part(kStd)) / all +
        before * more / (all * all) * apart * apart;
    of(kMin) = std::min(of(kMin), of_part(kMin));
    of(kMax) = std::max(of(kMax), of_part(kMax));
    of(kMean) = std::clamp(of(kMean) + apart * more / all, of(kMin), of(kMax));
    of(kStd) = std::sqrt(variance);
    for (std::size_t q = 0; q < kQuantiles.size(); ++q) {
      double& bound = of(kFirstQuantile + q);
      const double other = of_part(kFirstQuantile + q);
      bound = kQuantiles[q] <= 0.5 ? std::min(bound, other) : std::max(bound, other);
    }
  }
  total_.count += part.count;
}

}  // namespace probe::dataset
