// Points of which none is better in everything: fronts, their order, and how much they cover. Less is better in every
// objective.
#pragma once

#include <cstddef>
#include <vector>

namespace ctu::sweep {

using Objectives = std::vector<double>;

/// Not worse in any objective, and better in one.
bool dominates(const Objectives& a, const Objectives& b);

/// Indices of the points that no other dominates, in their order; of equal points the first.
std::vector<std::size_t> pareto_front(const std::vector<Objectives>& points);

/// Volume between the points and `reference`, exactly: of the union of the boxes from each point to it. Points that do
/// not reach beyond the reference add nothing. By slices along the last objective (While, Hingston, Barone, Huband,
/// "A faster algorithm for calculating hypervolume", 2006, section II: HSO).
double hypervolume(std::vector<Objectives> points, const Objectives& reference);

/// The number of each point's front: 0 for those that none dominates, 1 for those that only these dominate, and so on
/// (Deb, Pratap, Agarwal, Meyarivan, "A fast and elitist multiobjective genetic algorithm: NSGA-II", 2002, section
/// III.A).
std::vector<int> front_numbers(const std::vector<Objectives>& points);

/// How far a point of a front is from its neighbours, summed over objectives in shares of their range; infinite at the
/// ends (the same paper, section III.B).
std::vector<double> crowding_distances(const std::vector<Objectives>& front);

}  // namespace ctu::sweep
