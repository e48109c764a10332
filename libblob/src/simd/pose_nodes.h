// SPDX-License-Identifier: Apache-2.0
// The blobs and neighbours of posed nodes. Include after field.h.

// The blobs of a node at rest, turned by a matrix that includes the factor; the amplitude w stays, so
// that f'(X') = f(X).
inline void turnBlobs(const BlobBlock* rest, std::uint32_t count, const float* matrix,
                      float inverseSquare, BlobBlock* posed) {
  for (std::uint32_t b = 0; b < count; ++b) {
    const F8 x = load(rest[b].x), y = load(rest[b].y), z = load(rest[b].z);
    store(posed[b].x, (set1(matrix[0]) * x + set1(matrix[1]) * y) + set1(matrix[2]) * z);
    store(posed[b].y, (set1(matrix[3]) * x + set1(matrix[4]) * y) + set1(matrix[5]) * z);
    store(posed[b].z, (set1(matrix[6]) * x + set1(matrix[7]) * y) + set1(matrix[8]) * z);
    store(posed[b].a, load(rest[b].a) * set1(inverseSquare));
  }
}

// Centres and radii of the neighbours in a block, and their spacings; padding is at the node itself.
inline void gatherNeighbours(const blob_pose& pose, const NeighbourBlock& block, std::uint32_t node,
                             F8 place[4], F8& spacing) {
  float rows[kLanes][4], spacings[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t k = block.node[lane] == BLOB_NOWHERE ? node : block.node[lane];
    std::memcpy(rows[lane], pose.place[k].number, sizeof rows[lane]);
    spacings[lane] = pose.spacing[k];
  }
  fromRows(rows, place);
  spacing = load(spacings);
}

// Writes the radical planes and widths of a block, by the rules of makeNeighbour() in floats.
// Returns the least distance from the node at which one of them begins to blend, mm.
inline float placeBlock(const blob_pose& pose, const LaneKinds& kinds, std::uint32_t node,
                        NeighbourBlock& block) {
  F8 place[4], spacing;
  gatherNeighbours(pose, block, node, place, spacing);
  const float* own = pose.place[node].number;
  const F8 zero = set1(0.0f), r = set1(own[3]), kind = load(kinds.kind);
  const F8 dx = place[0] - set1(own[0]), dy = place[1] - set1(own[1]), dz = place[2] - set1(own[2]);
  const F8 square = (dx * dx + dy * dy) + dz * dz;
  const F8 c = square + (r - place[3]) * (r + place[3]), least = min(r, place[3]);
  const F8 apart = min(set1(0.5f) * square, set1(0.3f) * (set1(pose.spacing[node]) + spacing));
  const F8 width = select(less(zero, kind), set1(0.6f) * square, apart);
  const F8 tau = max(width, set1(1e-3f) * (least * least));
  const M8 isPadded = less(kind, zero);
  const F8 back = set1(-2.0f);
  store(block.nx, back * dx);
  store(block.ny, back * dy);
  store(block.nz, back * dz);
  store(block.c, select(isPadded, set1(kNeverLess), c));
  store(block.inverseTau, select(isPadded, set1(1.0f), set1(1.0f) / tau));
  constexpr float kRounding = 1e-5f;
  const F8 margin = (c - tau) - set1(kRounding) * (max(c, zero - c) + tau);
  const F8 slope = set1(2.0f * (1.0f + kRounding)) * sqrt(square);
  const F8 far = set1(static_cast<float>(kFarthestMm));
  const F8 begin = select(less(zero, margin), select(less(zero, slope), margin / slope, far), zero);
  return leastLane(select(isPadded, far, begin));
}

inline void placeNeighbours(blob_pose& pose, const std::uint32_t* nodes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    NodeRecord& record = pose.model.nodes[nodes[i]];
    const std::size_t first = record.firstNeighbours;
    float quiet = static_cast<float>(kFarthestMm);
    for (std::size_t b = 0; b < record.neighbourBlocks; ++b) {
      const float begin =
          placeBlock(pose, pose.laneKinds[first + b], nodes[i], pose.model.neighbours[first + b]);
      if (b > 0 && begin < quiet) quiet = begin;
    }
    record.centre[3] = static_cast<double>(quiet) * static_cast<double>(quiet);
  }
}

// Writes the blobs, centres and radii of nodes from their transforms.
inline void placeBlobs(blob_pose& pose, const std::uint32_t* nodes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t node = nodes[i];
    const NodePose& at = pose.pose[node];
    NodeRecord& record = pose.model.nodes[node];
    float* place = pose.place[node].number;
    const double centre[3] = {at.centre.x, at.centre.y, at.centre.z};
    for (int axis = 0; axis < 3; ++axis) {
      record.centre[axis] = centre[axis];
      place[axis] = static_cast<float>(centre[axis]);
    }
    place[3] = static_cast<float>(at.factor * static_cast<double>(pose.rest->nodes[node].radius()));
    record.field.place[3] = place[3];
    const Quaternion& q = at.rotation;
    store4(pose.rotation[node].quaternion,
           makeRow(static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2]),
                   static_cast<float>(q[3])));
    pose.inverseFactor[node] = static_cast<float>(1.0 / at.factor);
    if (pose.model.lender[node] != node) continue;
    float matrix[9];
    writeMatrix(at.rotation, at.factor, matrix);
    const FieldNode& field = record.field;
    turnBlobs(&pose.rest->field.blocks[field.block], field.blockCount, matrix,
              pose.inverseFactor[node] * pose.inverseFactor[node],
              &pose.model.field.blocks[field.block]);
  }
}

// Eight quaternions x, y, z, w, or vectors x, y, z and one more number.
struct Columns {
  F8 x, y, z, w;
};

inline Columns columnsOf(const float (*rows)[4]) {
  F8 c[4];
  fromRows(rows, c);
  return {c[0], c[1], c[2], c[3]};
}

// v turned back by q: v - 2 w (u x v) + 2 u x (u x v), with u the first three numbers of q.
inline Columns turnBack(const Columns& q, const Columns& v) {
  const F8 two = set1(2.0f), zero = set1(0.0f);
  const F8 tx = two * (q.y * v.z - q.z * v.y), ty = two * (q.z * v.x - q.x * v.z),
           tz = two * (q.x * v.y - q.y * v.x);
  return {v.x - q.w * tx + (q.y * tz - q.z * ty), v.y - q.w * ty + (q.z * tx - q.x * tz),
          v.z - q.w * tz + (q.x * ty - q.y * tx), zero};
}

// The inverse of a, times b.
inline Columns quotient(const Columns& a, const Columns& b) {
  return {
      a.w * b.x - a.x * b.w - a.y * b.z + a.z * b.y, a.w * b.y + a.x * b.z - a.y * b.w - a.z * b.x,
      a.w * b.z - a.x * b.y + a.y * b.x - a.z * b.w, a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z};
}

// About the angle between rotations a and b, radians: twice the lesser distance of their
// quaternions.
inline F8 angleBetween(const Columns& a, const Columns& b) {
  const auto squareOf = [&](float sign) {
    const F8 s = set1(sign), x = a.x - s * b.x, y = a.y - s * b.y, z = a.z - s * b.z,
             w = a.w - s * b.w;
    return (x * x + y * y) + (z * z + w * w);
  };
  return set1(2.0f) * sqrt(min(squareOf(1.0f), squareOf(-1.0f)));
}

// The length of an edge's change in the frame of one of its ends.
inline F8 stretchOf(const Columns& turn, F8 inverseFactor, const Columns& edge,
                    const Columns& was) {
  const Columns now = turnBack(turn, edge);
  const F8 x = now.x * inverseFactor - was.x, y = now.y * inverseFactor - was.y,
           z = now.z * inverseFactor - was.z;
  return sqrt((x * x + y * y) + z * z);
}

// The strains of eight edges.
inline F8 strainOfEight(const blob_pose& pose, const std::uint32_t* edges) {
  float place[2][kLanes][4], turn[2][kLanes][4], was[2][kLanes][4], turned[kLanes][4],
      inverse[2][kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const EdgeReference& edge = pose.edgeReference[edges[lane]];
    for (int end = 0; end < 2; ++end) {
      const std::uint32_t node = edge.node[end];
      store4(place[end][lane], load4(pose.place[node].number));
      store4(turn[end][lane], load4(pose.rotation[node].quaternion));
      inverse[end][lane] = pose.inverseFactor[node];
    }
    store4(was[0][lane], load4(edge.from));
    store4(was[1][lane], load4(edge.to));
    store4(turned[lane], load4(edge.turn));
  }
  const Columns a = columnsOf(place[0]), b = columnsOf(place[1]), from = columnsOf(turn[0]),
                to = columnsOf(turn[1]), wasFrom = columnsOf(was[0]), wasTo = columnsOf(was[1]);
  const Columns edge{b.x - a.x, b.y - a.y, b.z - a.z, a.w};
  const F8 stretch = max(stretchOf(from, load(inverse[0]), edge, wasFrom),
                         stretchOf(to, load(inverse[1]), edge, wasTo));
  const F8 angle = angleBetween(quotient(from, to), columnsOf(turned));
  return (stretch + wasTo.w * angle) * wasFrom.w;
}

inline float greatestStrain(const blob_pose& pose, const std::uint32_t* edges, std::size_t count) {
  F8 greatest = set1(0.0f);
  for (std::size_t first = 0; first < count; first += kLanes) {
    std::uint32_t eight[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      eight[lane] = edges[first + lane < count ? first + lane : first];
    greatest = max(greatest, strainOfEight(pose, eight));
  }
  return 0.0f - leastLane(set1(0.0f) - greatest);
}
