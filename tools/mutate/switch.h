// SPDX-License-Identifier: GPL-2.0-or-later
// What a mutated source calls in the place of its operators: the flip of a number takes the other operator if MUTANT is
// that number, the right one otherwise. See __init__.py.
#pragma once

#include <cmath>
#include <cstdlib>
#include <limits>
#include <type_traits>
#include <utility>

namespace mutant {

// Exit status where the other operator has no meaning: a number over a vector.
constexpr int kNoFlip = 99;

inline int active() {
  static const int number = std::getenv("MUTANT") ? std::atoi(std::getenv("MUTANT")) : 0;
  return number;
}

// An expression template of Eigen is worked out, since both ways have to be of one type.
template <class T, class = void>
struct Plain {
  using type = std::decay_t<T>;
};
template <class T>
struct Plain<T, std::void_t<typename std::decay_t<T>::PlainObject>> {
  using type = typename std::decay_t<T>::PlainObject;
};

#define MUTANT_PAIR(name, right, wrong)                                                             \
  template <class A, class B, class = void>                                                         \
  struct can_##name : std::false_type {};                                                           \
  template <class A, class B>                                                                       \
  struct can_##name<A, B, std::void_t<decltype(std::declval<A>() wrong std::declval<B>())>>         \
      : std::is_same<typename Plain<decltype(std::declval<A>() wrong std::declval<B>())>::type,     \
                     typename Plain<decltype(std::declval<A>() right std::declval<B>())>::type> {}; \
  template <class A, class B>                                                                       \
  auto name(int number, A&& a, B&& b) {                                                             \
    using P = typename Plain<decltype(std::forward<A>(a) right std::forward<B>(b))>::type;          \
    if constexpr (can_##name<A, B>::value) {                                                        \
      if (active() == number) return P(std::forward<A>(a) wrong std::forward<B>(b));                \
    } else if (active() == number) {                                                                \
      std::_Exit(kNoFlip);                                                                          \
    }                                                                                               \
    return P(std::forward<A>(a) right std::forward<B>(b));                                          \
  }
MUTANT_PAIR(add, +, -)
MUTANT_PAIR(subtract, -, +)
MUTANT_PAIR(multiply, *, /)
MUTANT_PAIR(divide, /, *)
MUTANT_PAIR(less, <, >)
MUTANT_PAIR(greater, >, <)
MUTANT_PAIR(less_equal, <=, >=)
MUTANT_PAIR(greater_equal, >=, <=)
MUTANT_PAIR(equal, ==, !=)
MUTANT_PAIR(unequal, !=, ==)
#undef MUTANT_PAIR

// A view of Eigen is a temporary that can be assigned to.
#define MUTANT_ASSIGN(name, right, wrong)                  \
  template <class A, class B>                              \
  decltype(auto) name(int number, A&& a, const B& b) {     \
    if (active() == number)                                \
      a wrong b;                                           \
    else                                                   \
      a right b;                                           \
    if constexpr (std::is_lvalue_reference_v<A>) return a; \
  }
MUTANT_ASSIGN(add_to, +=, -=)
MUTANT_ASSIGN(take_from, -=, +=)
MUTANT_ASSIGN(multiply_by, *=, /=)
MUTANT_ASSIGN(divide_by, /=, *=)
#undef MUTANT_ASSIGN

template <class A>
auto negative(int number, const A& a) {
  using P = typename Plain<decltype(-a)>::type;
  return active() == number ? P(a) : P(-a);
}

// A factor.
template <class A>
A factor(int number, A value) {
  if (active() != number) return value;
  if constexpr (std::is_integral_v<A>)
    return value + 1;
  else
    return value * 1.25;
}

template <class A>
A minimum(int number, const A& a, const A& b) {
  return (active() == number) != (b < a) ? b : a;
}
template <class A>
A maximum(int number, const A& a, const A& b) {
  return (active() == number) != (a < b) ? b : a;
}

}  // namespace mutant
