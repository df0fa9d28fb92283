// SPDX-License-Identifier: GPL-2.0-or-later
/* Independent integrator of one ViElTo contact: the printed equations as ordinary differential equations, fourth-order
   Runge-Kutta with a very small step. Written from the booklet (Thesis 2); shares nothing with liggghts_addons.

   Body 2 is a sphere, or a flat wall with unit normal `normal` whose plane holds its x (mass infinite,
   R_2 = wallRadiusFactor R_1). n points from body 2 to body 1; everything stored acts on body 1:

     dF_s/dt = turn x F_s - k_s v_s,   dM_r/dt = turn x M_r - k_r w_r,   dM_tw/dt = -k_tw w_tw

   with turn = n x dn/dt + the mean spin about n, the turn of the contact frame. Caps cut the stored values. */
#pragma once

#include <cmath>

#include "liggghts_runner.h"

namespace vielto_test {

struct Law {
  double springFactor = 4;
  double wallRadiusFactor = 2;
  bool limitForce = false;
  bool slidingDashpot = true;
  bool radiusLever = true;
  bool rollingDashpot = false;
};

class Contact {
 public:
  Contact(const Sphere& one, const Sphere& two, const Material& a, const Material& b, const Law& law)
      : law_(law), one_(one), two_(two), wall_(false), normal_(Vec::Zero()) {
    mix(a, b, two.radius);
  }
  Contact(const Sphere& one, const Sphere& wall, const Vec& normal, const Material& a, const Material& b,
          const Law& law)
      : law_(law), one_(one), two_(wall), wall_(true), normal_(normal) {
    mix(a, b, law.wallRadiusFactor * one.radius);
  }

  // Moves on by time t in steps of at most the contact time over `steps`. Springs are forgotten when the contact opens.
  void run(double t, int steps = 4000) {
    const double n = std::ceil(t / time_scale() * steps);
    for (long i = 0; i < std::lround(n); i++) step(t / n);
  }

  Sphere one() const { return moved(one_, 0); }
  Sphere two() const { return moved(two_, 9); }
  Vec spring() const { return state_.segment<3>(FS); }
  Vec rolling() const { return state_.segment<3>(MR); }
  double twisting() const { return state_[MTW]; }
  double time_scale() const { return pi * std::sqrt(mEff / (law_.springFactor * kn)); }  // undamped contact time, s

  double kn = 0, ks = 0, kr = 0, ktw = 0, cn = 0, cs = 0, mEff = 0;
  double greatestForce = 0, greatestOverlap = 0, duration = 0;  // of the run so far

 private:
  typedef Eigen::Matrix<double, 25, 1> State;  // x, v, w of either body, F_s, M_r, M_tw
  enum { X1, V1 = 3, W1 = 6, X2 = 9, V2 = 12, W2 = 15, FS = 18, MR = 21, MTW = 24 };

  struct Kinematics {
    Vec n, vs, wr, turn;
    double overlap, vn, wtw, lever1, lever2;
  };

  void mix(const Material& a, const Material& b, double R2) {
    const auto harmonic = [](double x, double y) { return x > 0 && y > 0 ? 2 / (1 / x + 1 / y) : 0.0; };
    R2_ = R2;
    const double R1 = one_.radius, k1 = 2 * a.youngsModulus * R1, k2 = 2 * b.youngsModulus * R2;
    mEff = wall_ ? one_.mass() : 1 / (1 / one_.mass() + 1 / two_.mass());
    kn = harmonic(k1, k2);
    ks = harmonic(k1 * a.stiffnessRatio, k2 * b.stiffnessRatio);
    const double twiceBetaS = a.tangentialDamping + b.tangentialDamping;
    cn = std::sqrt(kn * mEff) * (a.normalDamping + b.normalDamping);
    cs = std::sqrt(ks * mEff) * twiceBetaS;
    kr = harmonic(a.rollingStiffnessFactor, b.rollingStiffnessFactor) * kn * R1 * R2;
    ktw = harmonic(a.twistingStiffnessFactor, b.twistingStiffnessFactor) * ks * R1 * R2;
    tanPhi_ = std::tan((a.frictionAngle + b.frictionAngle) / 2 * pi / 180);
    const double length = harmonic(R1, R2);
    rollingArm_ = std::min(a.rollingResistance, b.rollingResistance) * length;
    twistingArm_ = std::min(a.twistingResistance, b.twistingResistance) * tanPhi_ * length;
    const double I = wall_ ? one_.inertia() : 1 / (1 / one_.inertia() + 1 / two_.inertia());
    cr_ = law_.rollingDashpot ? twiceBetaS * std::sqrt(kr * I) : 0;
    ctw_ = law_.rollingDashpot ? twiceBetaS * std::sqrt(ktw * I) : 0;
    state_ << one_.x, one_.v, one_.w, two_.x, two_.v, two_.w, Eigen::Matrix<double, 7, 1>::Zero();
  }

  Sphere moved(Sphere s, int at) const {
    s.x = state_.segment<3>(at), s.v = state_.segment<3>(at + 3), s.w = state_.segment<3>(at + 6);
    return s;
  }

  Kinematics kinematics(const State& y) const {
    const Vec apart = y.segment<3>(X1) - y.segment<3>(X2), v = y.segment<3>(V1) - y.segment<3>(V2);
    const Vec w1 = y.segment<3>(W1), w2 = y.segment<3>(W2);
    Kinematics k;
    k.n = wall_ ? normal_ : Vec(apart.normalized());
    k.overlap = wall_ ? one_.radius - apart.dot(normal_) : one_.radius + R2_ - apart.norm();
    k.lever1 = one_.radius - (law_.radiusLever ? 0 : 0.5 * k.overlap);
    k.lever2 = wall_ ? 0 : R2_ - (law_.radiusLever ? 0 : 0.5 * k.overlap);
    k.vn = v.dot(k.n);
    const Vec vt = v - k.vn * k.n;
    k.vs = vt + k.n.cross(k.lever1 * w1 + k.lever2 * w2);
    k.wtw = (w1 - w2).dot(k.n);
    k.wr = w1 - w2 - k.wtw * k.n;
    k.turn = 0.5 * (w1 + w2).dot(k.n) * k.n;
    if (!wall_) k.turn += k.n.cross(vt) / apart.norm();
    return k;
  }

  double normal_force(const Kinematics& k) const {
    const double F = law_.springFactor * kn * k.overlap - cn * k.vn;
    return law_.limitForce ? std::max(F, 0.0) : F;
  }

  // Cuts a vector to a length; tells whether it had to.
  static bool cut(Eigen::Ref<Eigen::VectorXd> v, double limit) {
    if (v.norm() <= limit) return false;
    v *= limit / v.norm();
    return true;
  }

  State rates(State y) const {
    State dy = State::Zero();
    dy.segment<3>(X1) = y.segment<3>(V1);
    dy.segment<3>(X2) = y.segment<3>(V2);
    const Kinematics k = kinematics(y);
    if (k.overlap <= 0) return dy;
    const Vec Fs = y.segment<3>(FS), Mr = y.segment<3>(MR);
    dy.segment<3>(FS) = k.turn.cross(Fs) - ks * k.vs;
    dy.segment<3>(MR) = k.turn.cross(Mr) - kr * k.wr;
    dy[MTW] = -ktw * k.wtw;

    const double F = normal_force(k), load = std::max(F, 0.0);
    cut(y.segment<3>(FS), load * tanPhi_);
    cut(y.segment<3>(MR), load * rollingArm_);
    cut(y.segment<1>(MTW), load * twistingArm_);
    Vec Ft = y.segment<3>(FS), M = y.segment<3>(MR) + y[MTW] * k.n;
    if (law_.slidingDashpot || !sliding_) Ft -= cs * k.vs;
    if (!rolling_) M -= cr_ * k.wr;
    if (!twisting_) M -= ctw_ * k.wtw * k.n;
    const Vec force = F * k.n + Ft;
    dy.segment<3>(V1) = force / one_.mass();
    dy.segment<3>(W1) = (M - k.lever1 * k.n.cross(Ft)) / one_.inertia();
    if (wall_) return dy;
    dy.segment<3>(V2) = -force / two_.mass();
    dy.segment<3>(W2) = (-M - k.lever2 * k.n.cross(Ft)) / two_.inertia();
    return dy;
  }

  void step(double dt) {
    const State a = rates(state_), b = rates(state_ + 0.5 * dt * a), c = rates(state_ + 0.5 * dt * b),
                d = rates(state_ + dt * c);
    state_ += dt / 6 * (a + 2 * b + 2 * c + d);
    const Kinematics k = kinematics(state_);
    if (k.overlap <= 0) {
      state_.segment<7>(FS).setZero();
      return;
    }
    const double F = normal_force(k), load = std::max(F, 0.0);
    sliding_ = cut(state_.segment<3>(FS), load * tanPhi_);
    rolling_ = cut(state_.segment<3>(MR), load * rollingArm_);
    twisting_ = cut(state_.segment<1>(MTW), load * twistingArm_);
    duration += dt;
    greatestForce = std::max(greatestForce, F);
    greatestOverlap = std::max(greatestOverlap, k.overlap);
  }

  Law law_;
  Sphere one_, two_;
  bool wall_;
  Vec normal_;
  double R2_ = 0, tanPhi_ = 0, rollingArm_ = 0, twistingArm_ = 0, cr_ = 0, ctw_ = 0;
  bool sliding_ = false, rolling_ = false, twisting_ = false;
  State state_;
};

}  // namespace vielto_test
