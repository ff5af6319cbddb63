#pragma once

#include "experiments/bench/peer.hpp"

namespace qddot::bench {

// boost::odeint's Dormand-Prince 5(4) with its step control.
std::unique_ptr<Peer> odeint_dopri5();
// boost::odeint's symplectic Runge-Kutta-Nystroem method of order 4 by McLachlan, fixed steps.
std::unique_ptr<Peer> odeint_mclachlan();
// SUNDIALS' ERKStep of order 4.
std::unique_ptr<Peer> arkode_erk4();
// One of our own methods, on the scene's smallest system or on the one with pins alone left out.
std::unique_ptr<Peer> our_method(const std::string& method, bool smallest);
// An implicit method of SUNDIALS with SUNDIALS' own matrix and solver: one of ours with a stock_of.
std::unique_ptr<Peer> stock_implicit(const std::string& method);
// A method of SciPy's solve_ivp: DOP853, Radau or BDF, in a process of its own. `force_library`:
// the path of force_library.cpp's library, through which Python calls our f; empty where there is
// none.
std::unique_ptr<Peer> scipy(const std::string& method, const std::string& force_library);
// Whether Debian's Python has SciPy.
bool has_scipy();
// Bullet's soft body; nullptr where the program was built without Bullet.
std::unique_ptr<Peer> bullet();
// LAMMPS' velocity Verlet over harmonic bonds, run by that program.
std::unique_ptr<Peer> lammps(const std::string& program = "lmp");
// Why there is no LAMMPS, in a sentence: the program is not found, or fails on the smallest scene.
// Empty where it works.
std::string why_no_lammps(const std::string& program = "lmp");

}  // namespace qddot::bench
