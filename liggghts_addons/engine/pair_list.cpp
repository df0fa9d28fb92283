// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/pair_list.h"

#include <string.h>

#include <vector>

#include "atom.h"
#include "engine/packed_law.h"
#include "error.h"
#include "fix_contact_history.h"
#include "lammps.h"
#include "my_page.h"
#include "neigh_list.h"
#include "neighbor.h"

namespace LAMMPS_NS {

namespace {

// Columns of BinnedGrains, kept from list to list.
class Sorted {
 public:
  void begin(size_t bins, size_t grains) {
    first_.assign(1, 0);
    first_.reserve(bins + 1);
    for (std::vector<double>& column : columns_) column.clear(), column.reserve(grains + spare);
  }
  void add(const double* x, double radius, int number) {
    const double values[5] = {x[0], x[1], x[2], radius, static_cast<double>(number)};
    for (int c = 0; c < 5; c++) columns_[c].push_back(values[c]);
  }
  void end_bin() { first_.push_back(columns_[0].size()); }
  void end() {
    for (std::vector<double>& column : columns_) column.resize(column.size() + spare);
  }
  size_t first(int bin) const { return first_[static_cast<size_t>(bin)]; }
  vielto::BinnedGrains grains() const {
    return {columns_[0].data(), columns_[1].data(), columns_[2].data(), columns_[3].data(), columns_[4].data()};
  }

  static constexpr size_t spare = 16;

 private:
  std::vector<size_t> first_;  // of each bin, and the end
  std::vector<double> columns_[5];
};

// By estimate: a bin that is visited costs about a nanosecond, a grain's neighbours a microsecond.
constexpr int bins_per_grain = 1000;

// Bins whose offsets follow one another.
struct Row {
  int offset, length;
};

}  // namespace

/* Never made: only lends Neighbor a member function, which LIGGGHTS calls by its table. It has no data and no virtual
   function of its own, so that a Neighbor will do; the sanitizers are told not to look for a builder there. */
class PairListBuilder : public Neighbor {
 public:
  typedef void (Neighbor::*Build)(NeighList*);

  __attribute__((no_sanitize("vptr"))) static void take(Neighbor* neighbor) {
    static_cast<PairListBuilder*>(neighbor)->take_all();
  }

 private:
  __attribute__((no_sanitize("vptr"))) void take_all() {
    if (!vielto::packed_law(lmp)) return;
    for (int k = 0; k < nlist; k++)
      if (pair_build[k] == static_cast<Build>(&PairListBuilder::granular_bin_no_newton))
        pair_build[k] = static_cast<Build>(&PairListBuilder::build_sorted);
  }

  __attribute__((no_sanitize("vptr"))) void build_sorted(NeighList* list) {
    const int grains = atom->nlocal + atom->nghost;
    // Few grains in a large box: to sort is to visit every bin, which takes longer than their chains save.
    const bool dilute = mbins / bins_per_grain > grains;
    if (includegroup || exclude || !list->fix_history || dilute) return granular_bin_no_newton(list);
    bin_atoms();
    static Sorted sorted;
    sorted.begin(mbins, grains);
    for (int bin = 0; bin < mbins; bin++) {
      for (int j = binhead[bin]; j >= 0; j = bins[j]) sorted.add(atom->x[j], atom->radius[j], j);
      sorted.end_bin();
    }
    sorted.end();
    std::vector<Row> rows;
    for (int k = 0; k < list->nstencil; k++)
      if (!rows.empty() && rows.back().offset + rows.back().length == list->stencil[k])
        rows.back().length++;
      else
        rows.push_back({list->stencil[k], 1});

    const vielto::PackedLaw& packed = *vielto::packed_law(lmp);
    std::vector<double> found(sorted.spare);
    NeighList* const histories = list->listgranhistory;
    list->ipage->reset();
    histories->ipage->reset();
    histories->dpage->reset();
    for (int i = 0; i < atom->nlocal; i++) {
      const int bin = coord2bin(atom->x[i]);
      const vielto::GrainToPair one = {atom->x[i][0],          atom->x[i][1],         atom->x[i][2], atom->radius[i],
                                       static_cast<double>(i), contactDistanceFactor, skin};
      size_t count = 0;
      for (const Row& row : rows) {
        const size_t from = sorted.first(bin + row.offset), to = sorted.first(bin + row.offset + row.length);
        if (found.size() < count + (to - from) + sorted.spare) found.resize(2 * (count + (to - from) + sorted.spare));
        if (from < to) count += packed.neighbours(sorted.grains(), one, from, to, found.data() + count);
      }
      keep(list, i, found.data(), static_cast<int>(count));
    }
    list->inum = atom->nlocal;
  }

  // As LIGGGHTS keeps a grain's neighbours: history where the pair is in contact and was.
  __attribute__((no_sanitize("vptr"))) void keep(NeighList* list, int i, const double* found, int count) {
    FixContactHistory* const history = list->fix_history;
    NeighList* const histories = list->listgranhistory;
    const int numbers = histories->dnum;
    int* const neighbours = list->ipage->vget();
    int* const flags = histories->ipage->vget();
    double* const values = histories->dpage->vget();
    if (!flags || !values) error->one(FLERR, "Neighbor list overflow, boost neigh_modify one");
    for (int n = 0; n < count; n++) {
      const int j = neighbours[n] = static_cast<int>(found[n]);
      double* const own = values + static_cast<ptrdiff_t>(n) * numbers;
      const double dx = atom->x[i][0] - atom->x[j][0], dy = atom->x[i][1] - atom->x[j][1],
                   dz = atom->x[i][2] - atom->x[j][2];
      const double square = dx * dx + dy * dy + dz * dz;
      const double radii = (atom->radius[i] + atom->radius[j]) * contactDistanceFactor;
      int m = 0;
      const int partners = square < radii * radii ? history->n_partner(i) : 0;
      while (m < partners && history->partner(i, m) != atom->tag[j]) m++;
      flags[n] = m < partners;
      if (flags[n])
        memcpy(own, history->contacthistory(i, m), numbers * sizeof(double));
      else
        memset(own, 0, numbers * sizeof(double));
    }
    list->ilist[i] = i;
    list->firstneigh[i] = neighbours;
    list->numneigh[i] = count;
    list->ipage->vgot(count);
    if (list->ipage->status()) error->one(FLERR, "Neighbor list overflow, boost neigh_modify one");
    histories->firstneigh[i] = flags;
    histories->firstdouble[i] = values;
    histories->ipage->vgot(count);
    histories->dpage->vgot(count * numbers);
  }
};

}  // namespace LAMMPS_NS

namespace vielto {

void take_pair_lists(LAMMPS_NS::Neighbor* neighbor) { LAMMPS_NS::PairListBuilder::take(neighbor); }

}  // namespace vielto
