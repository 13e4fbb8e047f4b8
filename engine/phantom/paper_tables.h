#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/model_record.h"
#include "engine/phantom/accuracy.h"
#include "engine/phantom/phantom.h"

namespace lumenline {

/// Mean over arc length and its standard deviation, of position and radius [%].
struct ErrorFigures {
    double position = 0, position_sigma = 0, radius = 0, radius_sigma = 0;
};

/// A cylinder of Tables 1 and 2 of Antiga et al. 2003: length 10 a, position errors in percent of the
/// greatest radius, radius errors in percent of the least.
struct PaperRow {
    std::string_view name;  ///< "3/5-40": aspect ratio, points around
    bool in_table_1, in_table_2;
    double b;  ///< least radius; the greatest is 5
    int points_around;
    ErrorFigures paper;
    std::optional<int> paper_vertices;    ///< Table 2 only
    std::optional<double> paper_seconds;  ///< Table 2 only: of the paper's machine
};

/// All rows of both tables, each once.
std::span<const PaperRow> paper_rows();

/// A shape with noise on its wall.
struct NoiseRow {
    std::string_view name;  ///< "torus-40-5%": shape, points around, noise
    PhantomKind kind;
    double b;
    double noise;  ///< standard deviation along the normal, in edges
};

/// The circular and the 3/5 cylinder and a torus, 40 points around, without noise and with 1, 5 and 10 %.
std::span<const NoiseRow> noise_rows();

/// Values over seeds.
class Spread {
public:
    void add(double value) { values_.push_back(value); }
    [[nodiscard]] std::size_t size() const { return values_.size(); }
    [[nodiscard]] double mean() const;
    /// Standard deviation of one value; zero for fewer than two.
    [[nodiscard]] double deviation() const;

private:
    std::vector<double> values_;
};

/// Errors of lines over seeds.
struct ErrorSpread {
    Spread position, position_sigma, radius, radius_sigma;

    void add(const LineError& error);
    [[nodiscard]] ErrorFigures mean() const;
};

/// What was measured of one row, over seeds.
struct RowFigures {
    ErrorSpread whole;  ///< all of the line but a quarter of the greatest radius at either end
    ErrorSpread inner;  ///< without 1.2 of the greatest radius at either end
    Spread vertices;    ///< of the open surface
    Spread seconds;     ///< all stages
    Spread growth;      ///< length of the line by that of the axis, less one [%]
};

/// A line through a phantom, from the start to the end of its axis.
struct PhantomLine {
    std::vector<Vec3> points;
    std::vector<double> radius;
    double seconds = 0;
};
/// Computes the line; throws what it likes.
using LineMaker = std::function<PhantomLine(const Phantom&)>;

/// Phantoms of seeds 1 to `seeds`, with 20 % tangential jitter, open ends and in general position,
/// against their truth.
RowFigures measure(const PaperRow& row, int seeds, const LineMaker& make_line);
RowFigures measure(const NoiseRow& row, int seeds, const LineMaker& make_line);

/// Distance from the wall to the axis of an elliptic cylinder within its section and along the medial
/// axis (eqs. 7 and 8): the wall point (a cos t, b sin t), a > b.
struct EllipseCharacter {
    double geodesic_distance = 0;              ///< (a^2 - b^2) / a |cos t| + b / a sqrt(a^2 sin^2 t + b^2 cos^2 t)
    double normalized_tangency_deviation = 0;  ///< the first term's share
};
EllipseCharacter ellipse_character(double a, double b, double t);

/// Errors of geodesic distance [% of the greatest radius] and normalized tangency deviation [its unit].
struct CharacterErrors {
    double distance_mean = 0, distance_max = 0, deviation_mean = 0, deviation_max = 0;
};

/// The 3/5 cylinder of length 6 a against its closed form.
struct CharacterRow {
    std::string_view name;  ///< "ntd-40": points around
    int points_around;
};

/// 20, 40, 80 and 160 points around.
std::span<const CharacterRow> character_rows();

/// Over the wall more than 1.2 of the greatest radius from either end and the sites that reach the line.
struct CharacterFigures {
    CharacterErrors pole;     ///< with the paper's pole
    CharacterErrors refined;  ///< with the ball that touches at the site
    std::size_t sites = 0;    ///< compared, over all seeds
    std::size_t unreached = 0;
};

/// Computes a phantom with its characterization; throws what it likes.
using RecordMaker = std::function<ModelRecord(const Phantom&)>;

/// As the other rows: means over sites and seeds, maxima over all.
CharacterFigures measure(const CharacterRow& row, int seeds, const RecordMaker& make_record);

}  // namespace lumenline
