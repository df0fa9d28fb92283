// SPDX-License-Identifier: GPL-2.0-or-later
// Memory bandwidth of one core: a = b + s c over arrays far larger than the caches, 24 bytes a number moved (as STREAM
// counts them: what the cache reads before it writes is not counted). Prints the best of a few rounds as JSON.
//   triad [MEGABYTES of each array, default 256]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

int main(int argc, char** argv) {
  const long megabytes = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 256;
  if (megabytes < 1) {
    std::fprintf(stderr, "triad: '%s' is no size; give megabytes above 0\n", argv[1]);
    return 2;
  }
  const std::size_t n = static_cast<std::size_t>(megabytes) * 1024 * 1024 / sizeof(double);
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
  double best = 0, check = 0;
  for (int round = 0; round < 5; ++round) {
    const double s = 3 + round;
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + s * c[i];
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    best = std::max(best, 24.0 * static_cast<double>(n) / took.count());
    check += a[n / 2];
  }
  if (check != 5 * 1 + 2.0 * (3 + 4 + 5 + 6 + 7)) return 1;
  std::printf("{\"bytes_per_s\": %.6g}\n", best);
  return 0;
}
