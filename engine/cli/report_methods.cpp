// Sentences are put together from the options as they were resolved, so that the text says what was done and not what
// is usually done.

#include "engine/cli/report_methods.h"

#include "engine/core/text.h"

namespace lumenline {

namespace {

std::string option(const MethodsFacts& facts, const std::string& key) {
    const auto found = facts.options.find(key);
    return found == facts.options.end() ? "" : found->second;
}

std::string surfaces(const MethodsFacts& facts) {
    std::string text = "Surfaces were welded (tolerance " + option(facts, "condition.weld_tolerance") +
                       " of the bounding box's diagonal), oriented and checked to be closed oriented manifolds";
    if (option(facts, "condition.fill_holes") == "true") text += ", small holes in the wall were closed";
    text += "; openings were extended by " + option(facts, "condition.extension_radii") +
            " of their radii and capped, and lines cut at the original planes.";
    if (const std::string decimate = option(facts, "condition.decimate"); decimate != "0" && !decimate.empty())
        text += " Surfaces were coarsened (decimate " + decimate + ").";
    return text;
}

std::string ends(const MethodsFacts& facts) {
    const std::string mode = option(facts, "endpoints.mode");
    if (mode == "points") return "Inlets and outlets were stated as points.";
    if (mode == "boundaries") return "The openings of each surface were its inlets and outlets.";
    if (mode == "caps") return "The flat caps of each surface were its inlets and outlets.";
    if (mode == "tips") return "The blind ends of each lumen were its inlets and outlets.";
    return "Inlets and outlets were the stated points, else the openings, flat caps or blind ends of each surface; the "
           "largest end was the inlet where none was stated.";
}

std::string lines(const MethodsFacts& facts) {
    std::string text =
        "Centerlines were computed as paths of least cost 1/R through the centres of maximal inscribed balls [1]: the "
        "Voronoi diagram embedded in the lumen was computed exactly (CGAL), the Eikonal equation |grad T| = 1/R was "
        "solved "
        "on its polygons from each inlet by Fast Marching with the closed-form cost along a segment, and paths were "
        "traced "
        "back from each outlet along the steepest descent and relaxed to least cost.";
    const std::string refine = option(facts, "centerlines.refine");
    if (refine == "medial")
        text +=
            " Lines were then refined off the Voronoi polygons against a smooth wall of quadric patches through the "
            "sites, with estimated errors of radius and position.";
    if (option(facts, "centerlines.topology") == "network")
        text += " Where the lumen has loops, lines run down both sides of each and form a network.";
    return text + " Every line was checked to lie inside the lumen and its balls against the distance to the wall.";
}

std::string wall(const MethodsFacts& facts) {
    if (!facts.characterized) return "";
    return "The wall was characterized by the geodesic distance D_g to the centerlines over the pole of each site and "
           "the "
           "Voronoi diagram (eqs. 6 and 7 of [1]), the Euclidean distance D_e to the corresponding point, and the "
           "normalized tangency deviation (eq. 8); statistics are weighted by area and leave out extensions, caps and "
           "the "
           "last radius before closed ends.";
}

std::string branches(const MethodsFacts& facts) {
    if (!facts.branched) return "";
    return "Lines were split into branches where they leave each other's tubes of inscribed balls [2]; curvature and "
           "torsion are those of local polynomials within " +
           option(facts, "branches.smoothing") + " radii, frames are carried along without turning [3], sections lie " +
           option(facts, "branches.section_step") +
           " mean radii apart. Stenoses are stated by the criteria of NASCET [4] and ECST [5] against a "
           "repeated-median "
           "line [6].";
}

}  // namespace

std::vector<std::string> methods_text(const MethodsFacts& facts) {
    std::vector<std::string> text;
    text.push_back("Geometry was computed with Lumenline " + facts.program + " (commit " + facts.commit + ", HDF5 " +
                   facts.hdf5 + ") for " + counted(facts.models, "model") + ", of which " +
                   std::to_string(facts.failed) + " could not be computed" +
                   (facts.rated_bad > 0
                        ? " and " + std::to_string(facts.rated_bad) + " were excluded by visual rating of their results"
                        : "") +
                   ". " + surfaces(facts) + " " + ends(facts));
    text.push_back(lines(facts));
    for (const std::string& paragraph : {wall(facts), branches(facts)})
        if (!paragraph.empty()) text.push_back(paragraph);
    return text;
}

std::vector<std::string> methods_references() {
    return {
        "Antiga L, Ene-Iordache B, Remuzzi A. Centerline computation and geometric analysis of branching tubular "
        "surfaces with application to blood vessel modeling. WSCG 2003.",
        "Antiga L, Steinman DA. Robust and objective decomposition and mapping of bifurcating vessels. IEEE Trans Med "
        "Imaging 2004; 23: 704.",
        "Wang W, J\xC3\xBCttler B, Zheng D, Liu Y. Computation of rotation minimizing frames. ACM Trans Graph 2008; "
        "27: 2.",
        "North American Symptomatic Carotid Endarterectomy Trial Collaborators. N Engl J Med 1991; 325: 445.",
        "European Carotid Surgery Trialists' Collaborative Group. Lancet 1991; 337: 1235.",
        "Siegel AF. Robust regression using repeated medians. Biometrika 1982; 69: 242.",
        "Iglewicz B, Hoaglin DC. How to detect and handle outliers. ASQC Quality Press, 1993."};
}

}  // namespace lumenline
