#pragma once

namespace qddot {

// Room for any number that write_digits writes.
constexpr int most_digits = 32;

// Writes a finite number with 17 significant digits, as printf's "%.17g" does to the last
// character, and returns where it ends. Several times as fast as the libraries for numbers from
// 1e-11 to 1e16, which almost all of a table are; others are left to fmt.
char* write_digits(double x, char* to);

}  // namespace qddot
