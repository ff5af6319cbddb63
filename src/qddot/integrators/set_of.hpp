#pragma once

#include <cstdint>
#include <initializer_list>

namespace qddot {

// A set of enumerators of E, fewer than 32.
template <class E>
class SetOf {
 public:
  constexpr SetOf() = default;
  constexpr SetOf(std::initializer_list<E> members) {
    for (const E member : members) bits_ |= bit(member);
  }

  constexpr bool has(E member) const { return (bits_ & bit(member)) != 0; }
  // The set with that member added if `is_in`.
  constexpr SetOf with(E member, bool is_in = true) const {
    SetOf more = *this;
    if (is_in) more.bits_ |= bit(member);
    return more;
  }
  constexpr bool operator==(const SetOf&) const = default;

 private:
  static constexpr std::uint32_t bit(E member) { return 1u << static_cast<unsigned>(member); }

  std::uint32_t bits_ = 0;
};

}  // namespace qddot
