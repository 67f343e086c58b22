#include "engine/cells/site_lists.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace qtrace {
namespace {

// Boxes are this long, in mean distances between an object's sites; shorter ones make shorter lists, and
// more.
constexpr double kBoxesPerSpacing = 0.7;
// Of an object that fills its bounds with surface, boxes must stay few enough for memory: 24 bytes each.
constexpr double kBoxesPerSite = 16;
constexpr double kFewestBoxes = 4096;
// A site that is farther from a box than so many of its edges is not looked for.
constexpr double kReach = 8;
constexpr double kShortestNormal =
    1e-3;                            // of an interpolated one; unit vectors shrink between unlike corners
constexpr double kWidestCone = 1.5;  // radians, below a right angle
constexpr double kGivenUp = -1;      // a squared radius within which nothing lies
// What rounding on the device can change of a squared distance, in parts of it, and of a cosine.
constexpr double kDistanceSlack = 1e-5;
constexpr double kCosineSlack = 1e-5;

// Where the surface lies in a box, with the normals that are nearest to one axis.
struct Surfaces {
  glm::dvec3 lo{std::numeric_limits<double>::infinity()};
  glm::dvec3 hi{-std::numeric_limits<double>::infinity()};
  std::vector<glm::dvec3> normals;  // their cone holds all others
  bool any_normal = false;          // unless this is so, where interpolated normals cancel
};

// All normals lie within an angle of the axis.
struct Cone {
  glm::dvec3 axis{0.0};
  double angle = 0;

  explicit Cone(const std::vector<glm::dvec3>& normals) {
    // All are within 55 degrees of one axis, so that their sum is not short.
    for (const glm::dvec3& n : normals) axis += n;
    axis = glm::normalize(axis);
    double cosine = 1;
    for (const glm::dvec3& n : normals) cosine = std::min(cosine, glm::dot(axis, n));
    angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  }
};

class ObjectBuilder {
 public:
  ObjectBuilder(std::span<const Triangle> triangles, std::span<const CellSite> sites,
                std::span<const SiteNode> nodes, double threshold)
      : triangles_(triangles), sites_(sites), nodes_(nodes), threshold_(threshold), frame_(make_frame()) {
    index_.assign(frame_.entries(), kNone);
    for (const Triangle& triangle : triangles_) add(triangle);
  }

  const GridFrame& frame() const { return frame_; }

  void append_to(SiteLists& lists) const {
    for (const std::uint32_t place : index_) {
      if (place != kNone && !append_list(surfaces_[place], lists.sites)) lists.complete = false;
      lists.starts.push_back(static_cast<std::uint32_t>(lists.sites.size()));
    }
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  GridFrame make_frame() const {
    glm::dvec3 lo(std::numeric_limits<double>::infinity());
    glm::dvec3 hi = -lo;
    double area = 0;
    for (const Triangle& t : triangles_) {
      for (const glm::vec3& p : t.position) {
        lo = glm::min(lo, glm::dvec3(p));
        hi = glm::max(hi, glm::dvec3(p));
      }
      area += area_of(t);
    }
    const glm::dvec3 size = hi - lo;
    const double longest = std::max({size.x, size.y, size.z});
    const double most = kBoxesPerSite * static_cast<double>(sites_.size()) + kFewestBoxes;
    double edge = std::max(kBoxesPerSpacing * std::sqrt(area / static_cast<double>(sites_.size())),
                           longest / kMostBoxesAlongAxis);
    const auto boxes = [&] { return glm::max(glm::ceil(size / edge), 1.0); };
    while (boxes().x * boxes().y * boxes().z > most) edge *= 1.1;
    return {glm::vec3(lo), static_cast<float>(1 / edge),
            glm::uvec3(glm::min(boxes(), double{kMostBoxesAlongAxis}))};
  }

  void add(const Triangle& triangle) {
    const glm::dvec3 face = glm::normalize(area_vector(triangle.position));
    const BoxedTriangle whole = boxed(frame_, triangle);
    for_each_piece(frame_, whole, [&](glm::uvec3 box, const Polygon& piece) {
      Polygon flat = piece;
      for (Corner& corner : flat) corner.normal = face;
      for (int k = 0; k < 3; ++k) {
        for (const std::uint32_t side : {0U, 1U}) {
          const auto along = [&](const Polygon& polygon) {
            const Polygon part = pointing_along(polygon, k, side == 0 ? 1 : -1);
            if (!part.empty())
              add_part(frame_.entry(box, 2 * static_cast<std::uint32_t>(k) + side), part, whole.slack);
          };
          along(piece);
          along(flat);  // the face's normal serves where the interpolated one faces away from the ray
        }
      }
    });
  }

  void add_part(std::size_t entry, const Polygon& part, double slack) {
    if (index_[entry] == kNone) {
      index_[entry] = static_cast<std::uint32_t>(surfaces_.size());
      surfaces_.emplace_back();
    }
    Surfaces& s = surfaces_[index_[entry]];
    for (const Corner& corner : part) {
      const auto world = [&](double shift) {
        return glm::dvec3(frame_.origin) + (corner.position + shift) / double{frame_.boxes_per_unit};
      };
      s.lo = glm::min(s.lo, world(-slack));
      s.hi = glm::max(s.hi, world(slack));
      const double length = glm::length(corner.normal);
      if (length < kShortestNormal) s.any_normal = true;
      if (s.any_normal) continue;
      const glm::dvec3 normal = corner.normal / length;
      if (std::ranges::find(s.normals, normal) == s.normals.end()) s.normals.push_back(normal);
    }
  }

  double least_distance2(const Surfaces& s, const glm::dvec3& p) const {
    const glm::dvec3 d = glm::max(glm::max(s.lo - p, p - s.hi), 0.0);
    return glm::dot(d, d);
  }

  double most_distance2(const Surfaces& s, const glm::dvec3& p) const {
    const glm::dvec3 d = glm::max(glm::abs(s.lo - p), glm::abs(s.hi - p));
    return glm::dot(d, d);
  }

  // Visits all sites of the tree below `node` that are not farther from the surface than the root of
  // `radius2`, which may shrink on the way, and some that are.
  template <class Visit>
  void visit_near(std::size_t node, const Surfaces& s, const double& radius2, const Visit& visit) const {
    if (node >= sites_.size()) return;
    visit(node);
    const int axis = nodes_[node].axis;
    const double split = sites_[node].position[axis];
    const double left = std::max(0.0, s.lo[axis] - split);
    const double right = std::max(0.0, split - s.hi[axis]);
    const std::size_t near = 2 * node + (left <= right ? 1 : 2);
    const std::size_t far = 2 * node + (left <= right ? 2 : 1);
    if (std::min(left, right) * std::min(left, right) <= radius2) visit_near(near, s, radius2, visit);
    if (std::max(left, right) * std::max(left, right) <= radius2) visit_near(far, s, radius2, visit);
  }

  // Returns whether there is one.
  bool append_list(const Surfaces& s, std::vector<ListedSite>& list) const {
    if (s.any_normal) return false;
    const Cone cone(s.normals);
    // Wider ones need not hold what lies between their normals.
    if (cone.angle >= kWidestCone) return false;
    // Cosine between a normal of the cone and the site's: the least and the largest.
    const auto cosine = [&](std::size_t site, double side) {
      const double angle =
          std::acos(std::clamp(glm::dot(cone.axis, glm::dvec3(sites_[site].normal)), -1.0, 1.0));
      return std::cos(std::clamp(angle + side * cone.angle, 0.0, glm::pi<double>()));
    };
    const auto always_fits = [&](std::size_t site) { return cosine(site, 1) > threshold_ + kCosineSlack; };
    const double reach = kReach / double{frame_.boxes_per_unit};
    double radius2 = reach * reach;
    bool is_sure = false;
    visit_near(0, s, radius2, [&](std::size_t site) {
      const double distance2 = most_distance2(s, sites_[site].position) * (1 + kDistanceSlack);
      if (distance2 >= radius2 || !always_fits(site)) return;
      radius2 = distance2;
      is_sure = true;
    });
    if (!is_sure) radius2 = std::numeric_limits<double>::infinity();
    const std::size_t first = list.size();
    visit_near(0, s, radius2, [&](std::size_t site) {
      const bool may_win = least_distance2(s, sites_[site].position) <= radius2;
      if (!may_win || cosine(site, -1) <= threshold_ - kCosineSlack) return;
      list.push_back({static_cast<std::uint32_t>(site), always_fits(site)});
      if (list.size() - first > kMostListedSites) radius2 = kGivenUp;
    });
    if (radius2 == kGivenUp) list.resize(first);
    std::ranges::sort(list.begin() + static_cast<std::ptrdiff_t>(first), list.end(), {}, &ListedSite::site);
    return radius2 != kGivenUp;
  }

  std::span<const Triangle> triangles_;
  std::span<const CellSite> sites_;
  std::span<const SiteNode> nodes_;
  double threshold_;
  GridFrame frame_;
  std::vector<std::uint32_t> index_;  // of surfaces_, by entry
  std::vector<Surfaces> surfaces_;
};

}  // namespace

SiteLists build_site_lists(const Scene& scene, const CellSites& cells, const std::vector<SiteNode>& nodes,
                           double cell_normal_threshold) {
  SiteLists lists;
  lists.starts.push_back(0);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    ObjectLists next;
    next.first_entry = static_cast<std::uint32_t>(lists.starts.size() - 1);
    const std::size_t count = cells.first[o + 1] - cells.first[o];
    if (count > 0 && object.triangle_count > 0) {
      const ObjectBuilder builder(
          std::span(scene.triangles).subspan(object.first_triangle, object.triangle_count),
          std::span(cells.sites).subspan(cells.first[o], count),
          std::span(nodes).subspan(cells.first[o], count), cell_normal_threshold);
      next.frame = builder.frame();
      builder.append_to(lists);
    }
    lists.objects.push_back(next);
  }
  return lists;
}

}  // namespace qtrace
