#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace lumenline {

/// Which model starts next: the queue, and what is free of places and memory. Models start in the order of the queue,
/// but while the first waits for memory, smaller ones behind it may start, until it has been passed by `most_passed`.
/// A model that needs more memory than there is starts when no other is in flight. Not thread-safe.
class Admission {
public:
    /// @param needs   estimated memory of each model, in the order of the queue [bytes]
    /// @param places  models that may be in flight at once
    /// @param memory  for all of them [bytes]; 0 = no bound
    Admission(const std::vector<double>& needs, int places, double memory);

    struct Admitted {
        std::size_t model;  ///< its place in the queue, from 0
        double bytes;       ///< what it takes from the memory
    };
    /// Admits the next model that there is room for; empty if there is none.
    std::optional<Admitted> next();

    /// A model in flight turns out to need so many bytes more (or, below zero, less). What is given back in the end
    /// is the sum.
    void correct(double more) { bytes_ -= more; }
    /// A model in flight has no use for its place any more.
    void free_place() { ++places_; }
    /// A model whose place is free has left.
    void leave(double bytes);

    [[nodiscard]] std::size_t waiting() const { return queue_.size(); }
    /// Models that may start now beside those in flight, as far as memory goes; at most `most`.
    [[nodiscard]] std::size_t would_fit(std::size_t most) const;

private:
    struct Waiting {
        std::size_t model;
        double bytes;
    };
    std::vector<Waiting>::reverse_iterator choose();

    std::vector<Waiting> queue_;  // in reverse: what is taken from it mostly stands at its end
    int places_, most_passed_;
    int in_flight_ = 0, passed_ = 0;
    double bytes_;
};

}  // namespace lumenline
