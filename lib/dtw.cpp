#include "lfdtools/dtw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "lfdtools/error.hpp"

// The hot loop is compiled for several instruction sets and chosen at run time. It adds, multiplies, takes roots and
// compares, each rounded alone, so that every version gives the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define LFD_DISPATCHED __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define LFD_DISPATCHED
#endif

namespace lfd {
namespace {

using Eigen::Index;

constexpr double infinity = std::numeric_limits<double>::infinity();

enum Step : std::int64_t { diagonal = 0, down = 1, right = 2 };  // came from (i-1,j-1), (i-1,j), (i,j-1)

void check_series(const Samples& a, const Samples& b, const DtwOptions& options) {
  if (a.rows() == 0 || b.rows() == 0) throw DataError("dtw.empty", "a series to compare has no samples");
  if (a.cols() != b.cols() || a.cols() == 0) {
    throw DataError("dtw.dimensions",
                    fmt::format("series of {} and {} signals cannot be compared", a.cols(), b.cols()));
  }
  if (!a.allFinite() || !b.allFinite()) {
    throw DataError("dtw.not_finite", "a series to compare has a value that is not a finite number");
  }
  if (options.window && !(*options.window > 0 && *options.window <= 1)) {
    throw UsageError("dtw.window", fmt::format("the window {} is not in (0, 1]", *options.window));
  }
}

/// Which cells (i, k - i) of anti-diagonal k = i + j lie in the matrix and in the band.
class Band {
 public:
  Band(Index rows, Index cols, const DtwOptions& options) : rows_(rows), cols_(cols), radius_(std::max(rows, cols)) {
    if (options.window && *options.window < 1) {
      const auto wanted = static_cast<Index>(std::ceil(*options.window * static_cast<double>(radius_)));
      radius_ = std::max(wanted, std::abs(rows - cols));
    }
  }
  [[nodiscard]] Index diagonals() const { return rows_ + cols_ - 1; }
  [[nodiscard]] Index first(Index k) const {
    const Index edge = k > radius_ ? (k - radius_ + 1) / 2 : 0;  // rounded up
    return std::max(edge, k - (cols_ - 1));
  }
  [[nodiscard]] Index last(Index k) const { return std::min({rows_ - 1, k, (k + radius_) / 2}); }

 private:
  Index rows_;
  Index cols_;
  Index radius_;
};

/// out_i = squared difference, added to what is there unless `fresh`.
LFD_DISPATCHED void add_squares(double* __restrict out, const double* __restrict a, const double* __restrict b,
                                bool fresh, Index count) {
  if (fresh) {
    for (Index i = 0; i < count; ++i) out[i] = (a[i] - b[i]) * (a[i] - b[i]);
  } else {
    for (Index i = 0; i < count; ++i) out[i] += (a[i] - b[i]) * (a[i] - b[i]);
  }
}

/// One anti-diagonal of the recursion: no cell depends on another of the same diagonal.
/// @param square  squared local distances   @param before, before2  the diagonals k - 1 and k - 2 at row i - 1
LFD_DISPATCHED void advance(double* __restrict cost, const double* __restrict square, const double* __restrict before,
                            const double* __restrict before2, Index count) {
  for (Index i = 0; i < count; ++i) {
    double least = before2[i];
    least = before[i] < least ? before[i] : least;
    least = before[i + 1] < least ? before[i + 1] : least;
    cost[i] = std::sqrt(square[i]) + least;
  }
}

/// The same with the step that led to each cell; strict comparisons prefer the diagonal.
LFD_DISPATCHED void advance_with_steps(double* __restrict cost, std::int64_t* __restrict step,
                                       const double* __restrict square, const double* __restrict before,
                                       const double* __restrict before2, Index count) {
  for (Index i = 0; i < count; ++i) {
    double least = before2[i];
    std::int64_t taken = diagonal;
    taken = before[i] < least ? std::int64_t{down} : taken;
    least = before[i] < least ? before[i] : least;
    taken = before[i + 1] < least ? std::int64_t{right} : taken;
    least = before[i + 1] < least ? before[i + 1] : least;
    cost[i] = std::sqrt(square[i]) + least;
    step[i] = taken;
  }
}

/// Steps, 2 bits each, four to a byte.
LFD_DISPATCHED void pack(std::uint8_t* __restrict packed, const std::int64_t* __restrict step, Index bytes) {
  for (Index i = 0; i < bytes; ++i) {
    const std::int64_t* s = step + 4 * i;
    packed[i] = static_cast<std::uint8_t>(s[0] | s[1] << 2 | s[2] << 4 | s[3] << 6);
  }
}

/// Steps of all cells, by anti-diagonal.
struct StepTable {
  std::vector<std::uint8_t> packed;
  std::vector<std::size_t> begin;  // first byte of each diagonal

  [[nodiscard]] Step at(const Band& band, Index i, Index j) const {
    const auto place = static_cast<std::size_t>(i - band.first(i + j));
    return static_cast<Step>(packed[begin[static_cast<std::size_t>(i + j)] + place / 4] >> (2 * (place % 4)) & 3);
  }
};

/// Sweeps the anti-diagonals; fills the table when there is one. @return the cost of the last cell
double sweep(const Samples& a, const Samples& b, const Band& band, StepTable* table) {
  const Index n = a.rows();
  const Index m = b.rows();
  const Matrix columns_a = a;                      // one signal after the other
  const Matrix columns_b = b.colwise().reverse();  // row m-1-j: on an anti-diagonal it rises with i
  Vector square(n);
  std::vector<std::int64_t> step(table ? static_cast<std::size_t>(n) + 4 : 0, 0);
  // Row i of a diagonal is at i + 1; what lies outside the band is infinite.
  Vector before2 = Vector::Constant(n + 2, infinity);
  Vector before = before2;
  Vector cost = before2;
  before2[0] = 0;  // the empty path, diagonally before (0, 0)
  if (table) {
    std::size_t bytes = 0;
    for (Index k = 0; k < band.diagonals(); ++k) {
      table->begin.push_back(bytes);
      bytes += static_cast<std::size_t>(band.last(k) - band.first(k) + 4) / 4;
    }
    table->packed.resize(bytes);
  }
  for (Index k = 0; k < band.diagonals(); ++k) {
    const Index i = band.first(k);
    const Index count = band.last(k) - i + 1;
    for (Index d = 0; d < a.cols(); ++d) {
      add_squares(square.data(), &columns_a(i, d), columns_b.col(d).data() + (m - 1 - k + i), d == 0, count);
    }
    if (table) {
      advance_with_steps(&cost[i + 1], step.data(), square.data(), &before[i], &before2[i], count);
      pack(table->packed.data() + table->begin[static_cast<std::size_t>(k)], step.data(), (count + 3) / 4);
    } else {
      advance(&cost[i + 1], square.data(), &before[i], &before2[i], count);
    }
    cost[i] = infinity;
    cost[i + count + 1] = infinity;
    before2.swap(before);
    before.swap(cost);
  }
  if (!std::isfinite(before[n])) throw DataError("dtw.overflow", "the distances between two series are too large");
  return before[n];
}

}  // namespace

double dtw_cost(const Samples& a, const Samples& b, const DtwOptions& options) {
  check_series(a, b, options);
  return sweep(a, b, Band(a.rows(), b.rows(), options), nullptr);
}

DtwPath dtw(const Samples& a, const Samples& b, const DtwOptions& options) {
  check_series(a, b, options);
  const Band band(a.rows(), b.rows(), options);
  StepTable table;
  DtwPath path;
  path.cost = sweep(a, b, band, &table);
  Index i = a.rows() - 1;
  Index j = b.rows() - 1;
  path.steps.emplace_back(i, j);
  while (i > 0 || j > 0) {
    const Step step = table.at(band, i, j);
    i -= step != right;
    j -= step != down;
    path.steps.emplace_back(i, j);
  }
  std::reverse(path.steps.begin(), path.steps.end());
  return path;
}

}  // namespace lfd
