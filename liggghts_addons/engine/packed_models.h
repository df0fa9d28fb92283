// SPDX-License-Identifier: GPL-2.0-or-later
/* What packed_law.h needs of the contact models of a style. A style packs when each of its models that is not off
   describes its settings (`describe`), as ViElTo's adapters do; LIGGGHTS' own do not. */
#ifndef VIELTO_PACKED_MODELS_H
#define VIELTO_PACKED_MODELS_H

#include <type_traits>

#include "engine/packed_law.h"
#include "engine/packed_wall.h"
#include "engine/private_access.h"

namespace vielto {

// see private_access.h
template <class Style>
struct ModelOfPair {
  typedef LIGGGHTS::ContactModels::ContactModel<Style> Model;
  typedef Model LIGGGHTS::PairStyles::Granular<Model>::*type;
};
template <class Style>
struct ModelOfWall {
  typedef LIGGGHTS::ContactModels::ContactModel<Style> Model;
  typedef Model LIGGGHTS::Walls::Granular<Model>::*type;
};
template <class Style, class Part>
struct PartOfModel {
  typedef Part LIGGGHTS::ContactModels::ContactModel<Style>::*type;
};

#define VIELTO_OPEN_MODELS(STYLE)                                                                                \
  template struct Opened<ModelOfPair<STYLE>,                                                                     \
                         &LIGGGHTS::PairStyles::Granular<LIGGGHTS::ContactModels::ContactModel<STYLE>>::cmodel>; \
  template struct Opened<ModelOfWall<STYLE>,                                                                     \
                         &LIGGGHTS::Walls::Granular<LIGGGHTS::ContactModels::ContactModel<STYLE>>::cmodel>;      \
  template struct Opened<PartOfModel<STYLE, LIGGGHTS::ContactModels::NormalModel<STYLE::MODEL>>,                 \
                         &LIGGGHTS::ContactModels::ContactModel<STYLE>::normalModel>;                            \
  template struct Opened<PartOfModel<STYLE, LIGGGHTS::ContactModels::CohesionModel<STYLE::COHESION>>,            \
                         &LIGGGHTS::ContactModels::ContactModel<STYLE>::cohesionModel>;                          \
  template struct Opened<PartOfModel<STYLE, LIGGGHTS::ContactModels::TangentialModel<STYLE::TANGENTIAL>>,        \
                         &LIGGGHTS::ContactModels::ContactModel<STYLE>::tangentialModel>;                        \
  template struct Opened<PartOfModel<STYLE, LIGGGHTS::ContactModels::RollingModel<STYLE::ROLLING>>,              \
                         &LIGGGHTS::ContactModels::ContactModel<STYLE>::rollingModel>;

template <class Model, class = void>
struct Describes : std::false_type {};
template <class Model>
struct Describes<Model, decltype(std::declval<const Model&>().describe(std::declval<LawSettings&>()))>
    : std::true_type {};

template <class Style>
class PackedModels {
  typedef LIGGGHTS::ContactModels::ContactModel<Style> Model;
  typedef LIGGGHTS::ContactModels::NormalModel<Style::MODEL> Normal;
  typedef LIGGGHTS::ContactModels::CohesionModel<Style::COHESION> Cohesion;
  typedef LIGGGHTS::ContactModels::TangentialModel<Style::TANGENTIAL> Tangential;
  typedef LIGGGHTS::ContactModels::RollingModel<Style::ROLLING> Rolling;
  static constexpr bool cohesive = Style::COHESION != LIGGGHTS::ContactModels::COHESION_OFF;
  static constexpr bool rolls = Style::ROLLING != LIGGGHTS::ContactModels::ROLLING_OFF;

 public:
  static constexpr bool packs = Describes<Normal>::value && Describes<Tangential>::value &&
                                (!cohesive || Describes<Cohesion>::value) && (!rolls || Describes<Rolling>::value);
  // what the models of a contact that touches set
  static constexpr int flags = LIGGGHTS::ContactModels::CONTACT_NORMAL_MODEL |
                               LIGGGHTS::ContactModels::CONTACT_TANGENTIAL_MODEL |
                               (cohesive ? LIGGGHTS::ContactModels::CONTACT_COHESION_MODEL : 0) |
                               (rolls ? LIGGGHTS::ContactModels::CONTACT_ROLLING_MODEL : 0);

  static PackedStep step(const Model& model) {
    PackedStep step = PackedStep();
    if constexpr (packs) {
      step.pairs = pairs(model).all();
      part<Normal>(model).describe(step.settings);
      part<Tangential>(model).describe(step.settings);
      if constexpr (cohesive) part<Cohesion>(model).describe(step.settings);
      if constexpr (rolls) part<Rolling>(model).describe(step.settings);
    }
    return step;
  }
  static const PairTable& pairs(const Model& model) { return part<Normal>(model).pairs(); }
  template <class Contact>
  static void watch(Model& model, const Contact& contact, double diameter) {
    (model.*Handed<PartOfModel<Style, Normal>>::pointer).watch(contact, diameter);
  }

 private:
  template <class Part>
  static const Part& part(const Model& model) {
    return model.*Handed<PartOfModel<Style, Part>>::pointer;
  }
};

// LIGGGHTS' wall with a law that packs.
template <class Style>
class WallThatPacks : public LIGGGHTS::Walls::Granular<LIGGGHTS::ContactModels::ContactModel<Style>>,
                      public PackedWall {
  typedef LIGGGHTS::Walls::Granular<LIGGGHTS::ContactModels::ContactModel<Style>> Wall;
  typedef PackedModels<Style> Packed;

 public:
  WallThatPacks(LAMMPS_NS::LAMMPS* program, LAMMPS_NS::FixWallGran* owner, int64_t hash)
      : Wall(program, owner, hash), model_(this->*Handed<ModelOfWall<Style>>::pointer) {}
  PackedStep packed_step() const override { return Packed::step(model_); }
  int place(int itype, int jtype) const override { return Packed::pairs(model_).place(itype, jtype); }
  void watch(const LIGGGHTS::ContactModels::SurfacesIntersectData& contact, double diameter) override {
    Packed::watch(model_, contact, diameter);
  }

 private:
  typename ModelOfWall<Style>::Model& model_;
};

template <class Style>
LIGGGHTS::Walls::IGranularWall* new_wall(LAMMPS_NS::LAMMPS* program, LAMMPS_NS::FixWallGran* parent, int64_t hash) {
  if constexpr (PackedModels<Style>::packs)
    return new WallThatPacks<Style>(program, parent, hash);
  else
    return new LIGGGHTS::Walls::Granular<LIGGGHTS::ContactModels::ContactModel<Style>>(program, parent, hash);
}

}  // namespace vielto

#endif
