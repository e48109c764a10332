// SPDX-License-Identifier: Apache-2.0
// libblob's query in WGSL, blob_query_points() and blob_query_exact_points(): an invocation for each
// tool point. Generated from blob_device_exact.h and the headers that it includes, which explain each function and the buffer, by
// libblob/device/translate/translate.py; change those.
//
// A pointer of C into the buffer is the index of a word here: words is that of the buffer's first
// word, 0 unless other data lie before it. Outputs are pointers to variables of a function. Points
// are finite: WGSL promises nothing for NaN and infinities.

@group(0) @binding(0) var<storage, read> blob_device_buffer: array<u32>;

const BLOB_DEVICE_MAGIC: u32 = 0x5642424cu;
const BLOB_DEVICE_VERSION: u32 = 2u;
const BLOB_DEVICE_HEADER_WORDS: u32 = 4u;
const BLOB_DEVICE_VESSEL_WORDS: u32 = 8u;
const BLOB_DEVICE_NODE_WORDS: u32 = 16u;
const BLOB_DEVICE_NEIGHBOUR_WORDS: u32 = 48u;
const BLOB_DEVICE_BLOB_WORDS: u32 = 40u;
const BLOB_DEVICE_ALIGN_WORDS: u32 = 16u;
const BLOB_DEVICE_BLENDED: u32 = 0u;
const BLOB_DEVICE_LOCAL: u32 = 1u;
const BLOB_DEVICE_HOLD: u32 = 4u;
const BLOB_DEVICE_INSIDE: u32 = 1u;
const BLOB_DEVICE_NOWHERE: u32 = 0xffffffffu;
const BLOB_DEVICE_SIMT: i32 = 0;
const BLOB_DEVICE_WIDE: i32 = 0;
const BLOB_DEVICE_MANY: u32 = 0xffffffffu;
const BLOB_DEVICE_MOST_ACTIVE: i32 = 24;
const BLOB_DEVICE_AT_POINT: u32 = 0u;
const BLOB_DEVICE_APPROACHING: u32 = 1u;
const BLOB_DEVICE_BESIDE: u32 = 2u;
const BLOB_DEVICE_GLIDING: u32 = 3u;
const BLOB_DEVICE_CURVING: u32 = 4u;
const BLOB_DEVICE_PROJECTING: u32 = 5u;
const BLOB_DEVICE_FOUND: u32 = 6u;
const BLOB_DEVICE_STOPPED: u32 = 7u;
const BLOB_DEVICE_EXACT: u32 = 2u;
const BLOB_DEVICE_NOT_CONVERGED: u32 = 2u;

struct blob_device_sample {
  value: f32,
  gradient: array<f32, 3>,
  distance: f32,
  normal: array<f32, 3>,
  node: u32,
  state: u32,
}

struct blob_device_vessel {
  words: u32,
  phi: u32,
  node_count: u32,
  nodes: u32,
  neighbours: u32,
  blobs: u32,
  level: f32,
  transformed_level: f32,
}

struct blob_device_place {
  point: array<f32, 3>,
  step: array<f32, 3>,
}

struct blob_device_node {
  record: u32,
  neighbour: u32,
  blocks: u32,
  rivals: u32,
  x: array<f32, 3>,
}

struct blob_device_lane {
  field: array<f32, 4>,
  shift: f32,
  radius: f32,
}

struct blob_device_eight {
  lanes: array<f32, 8>,
}

struct blob_device_active {
  nodes: array<u32, BLOB_DEVICE_MOST_ACTIVE>,
  count: i32,
}

struct blob_device_mixture {
  weight: array<f32, 4>,
  excess: array<f32, 4>,
  field: array<f32, 4>,
  f0: f32,
  shift: f32,
  radius: f32,
  is_empty: i32,
}

struct blob_device_foot {
  at: array<f32, 3>,
  normal: array<f32, 3>,
  value: f32,
  distance: f32,
  node: u32,
}

struct blob_device_search {
  here: blob_device_foot,
  best: blob_device_foot,
  first: array<f32, 3>,
  second: array<f32, 3>,
  diagonal: array<f32, 3>,
  mixed: array<f32, 3>,
  begun: array<f32, 3>,
  before: array<f32, 3>,
  turned: array<f32, 3>,
  step: array<f32, 3>,
  length: f32,
  sag: f32,
  gain: f32,
  share: f32,
  reached: f32,
  nearest: f32,
  radius: f32,
  tolerance: f32,
  first_distance: f32,
  stage: u32,
  is_inside: i32,
  is_improving: i32,
  tried: i32,
  places: i32,
  steps: i32,
  slow: i32,
}

fn blob_device_lesser(a: f32, b: f32) -> f32 {
  return select(b, a, a < b);
}

fn blob_device_greater(a: f32, b: f32) -> f32 {
  return select(b, a, b < a);
}

fn blob_device_norm(v: array<f32, 3>) -> f32 {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

fn blob_device_exp(unbounded: f32) -> f32 {
  let x: f32 = select(select(unbounded, 88.0f, unbounded > 88.0f), -87.0f, unbounded < -87.0f);
  let scaled: f32 = x * 1.44269504f;
  let rest: f32 = scaled - f32(i32(scaled));
  let n: i32 = i32(scaled) + select(select(0, -1, rest < -0.5f), 1, rest > 0.5f);
  let r: f32 = x - f32(n) * 0.693359375f - f32(n) * -2.12194440e-4f;
  var p: f32 = 1.9875691500e-4f;
  var power: u32;
  p = p * r + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  power = u32(n + 127) << 23u;
  return (p * (r * r) + (r + 1.0f)) * bitcast<f32>(power);
}

fn blob_device_log(x: f32) -> f32 {
  var bits: u32;
  var exponent: i32;
  var m: f32;
  var p: f32;
  var e: f32;
  var square: f32;
  bits = bitcast<u32>(x);
  exponent = i32(bits >> 23u) - 126;
  bits = (bits & 0x007fffffu) | 0x3f000000u;
  m = bitcast<f32>(bits);
  if (m < 0.70710678f) {
    exponent -= 1;
    m = m + m;
  }
  m -= 1.0f;
  p = 7.0376836292e-2f;
  p = p * m + -1.1514610310e-1f;
  p = p * m + 1.1676998740e-1f;
  p = p * m + -1.2420140846e-1f;
  p = p * m + 1.4249322787e-1f;
  p = p * m + -1.6668057665e-1f;
  p = p * m + 2.0000714765e-1f;
  p = p * m + -2.4999993993e-1f;
  p = p * m + 3.3333331174e-1f;
  e = f32(exponent);
  square = m * m;
  return m + (m * square * p + e * -2.12194440e-4f - 0.5f * square) + e * 0.693359375f;
}

fn blob_device_open(words: u32, index: u32) -> blob_device_vessel {
  let at: u32 = BLOB_DEVICE_HEADER_WORDS + BLOB_DEVICE_VESSEL_WORDS * index;
  var v: blob_device_vessel;
  v.words = words;
  v.phi = blob_device_buffer[words + at];
  v.node_count = blob_device_buffer[words + (at + 1u)];
  v.nodes = blob_device_buffer[words + (at + 2u)];
  v.neighbours = blob_device_buffer[words + (at + 3u)];
  v.blobs = blob_device_buffer[words + (at + 4u)];
  v.level = bitcast<f32>(blob_device_buffer[words + (at + 5u)]);
  v.transformed_level = bitcast<f32>(blob_device_buffer[words + (at + 6u)]);
  return v;
}

fn blob_device_place_at(point: array<f32, 3>) -> blob_device_place {
  var place: blob_device_place;
  place.point[0] = point[0];
  place.point[1] = point[1];
  place.point[2] = point[2];
  place.step[0] = 0.0f;
  place.step[1] = 0.0f;
  place.step[2] = 0.0f;
  return place;
}

fn blob_device_at(v: blob_device_vessel, index: u32, place: blob_device_place) -> blob_device_node {
  let record: u32 = v.words + v.nodes + BLOB_DEVICE_NODE_WORDS * index;
  let x: f32 = place.point[0] - bitcast<f32>(blob_device_buffer[record]) -
      bitcast<f32>(blob_device_buffer[record + 12u]) + place.step[0];
  let y: f32 = place.point[1] - bitcast<f32>(blob_device_buffer[record + 1u]) -
      bitcast<f32>(blob_device_buffer[record + 13u]) + place.step[1];
  let z: f32 = place.point[2] - bitcast<f32>(blob_device_buffer[record + 2u]) -
      bitcast<f32>(blob_device_buffer[record + 14u]) + place.step[2];
  let square: f32 = x * x + y * y + z * z;
  var node: blob_device_node;
  node.record = record;
  node.x[0] = x;
  node.x[1] = y;
  node.x[2] = z;
  node.rivals = 0u;
  node.blocks = blob_device_buffer[node.record + 11u];
  if (node.blocks > 1u && square < bitcast<f32>(blob_device_buffer[node.record + 7u])) {
    node.blocks = 1u;
  }
  node.neighbour = v.words + v.neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS *
      blob_device_buffer[node.record + 10u];
  return node;
}

fn blob_device_locate(v: blob_device_vessel, place: blob_device_place) -> u32 {
  var best: u32 = 0u;
  var least: f32 = 3e38f;
  for (var i: u32 = 0u; i < v.node_count; i += 1u) {
    let node: blob_device_node = blob_device_at(v, i, place);
    let r: f32 = bitcast<f32>(blob_device_buffer[node.record + 3u]);
    let power: f32 = node.x[0] * node.x[0] + node.x[1] * node.x[1] + node.x[2] * node.x[2] - r * r;
    if (power < least) {
      least = power;
      best = i;
    }
  }
  return best;
}

fn blob_device_difference(block: u32, lane: u32, x: array<f32, 3>) -> f32 {
  let k: u32 = block + lane;
  return bitcast<f32>(blob_device_buffer[k]) * x[0] + bitcast<f32>(blob_device_buffer[k + 8u]) *
      x[1] + bitcast<f32>(blob_device_buffer[k + 16u]) * x[2] +
      bitcast<f32>(blob_device_buffer[k + 24u]);
}

fn blob_device_step(s: f32) -> f32 {
  return (6.0f * s - 15.0f) * s + 10.0f;
}

fn blob_device_exponent(blob: u32, at: array<f32, 3>, d: ptr<function, array<f32, 3>>) -> f32 {
  (*d)[0] = at[0] - bitcast<f32>(blob_device_buffer[blob]);
  (*d)[1] = at[1] - bitcast<f32>(blob_device_buffer[blob + 8u]);
  (*d)[2] = at[2] - bitcast<f32>(blob_device_buffer[blob + 16u]);
  return bitcast<f32>(blob_device_buffer[blob + 24u]) *
      ((*d)[0] * (*d)[0] + (*d)[1] * (*d)[1] + (*d)[2] * (*d)[2]);
}

fn blob_device_term(phi: u32, u: f32, a: f32, w: f32, slope: ptr<function, f32>) -> f32 {
  var q: f32;
  var value: f32;
  if (phi == 0u) {
    q = 1.0f / (1.0f + u);
    value = w * (q * q);
    (*slope) = -4.0f * a * (value * q);
    return value;
  }
  if (phi == 1u) {
    value = w * blob_device_exp(-u);
    (*slope) = -2.0f * a * value;
    return value;
  }
  q = blob_device_greater(1.0f - u, 0.0f);
  if (phi == 2u) {
    (*slope) = -4.0f * a * (w * q);
    return w * (q * q);
  }
  (*slope) = -2.0f / 9.0f * a * (w * q) * (10.0f + 12.0f * q);
  return w * (q * q) * (5.0f + 4.0f * q) * (1.0f / 9.0f);
}

fn blob_device_total(e: blob_device_eight) -> f32 {
  return e.lanes[0] + e.lanes[2] + (e.lanes[1] + e.lanes[3]) +
      (e.lanes[4] + e.lanes[6] + (e.lanes[5] + e.lanes[7]));
}

fn blob_device_first(bits: u32) -> u32 {
  var found: u32 = 8u;
  for (var i: u32 = 0u; i < 8u; i += 1u) {
    if (found == 8u && ((bits >> i) & 1u) != 0u) {
      found = i;
    }
  }
  return found;
}

fn blob_device_count(bits: u32) -> u32 {
  var count: u32 = 0u;
  for (var i: u32 = 0u; i < 8u; i += 1u) {
    count += (bits >> i) & 1u;
  }
  return count;
}

fn blob_device_below(block: u32, x: array<f32, 3>, limit: f32) -> u32 {
  var bits: u32 = 0u;
  for (var i: u32 = 0u; i < 8u; i += 1u) {
    if (blob_device_difference(block, i, x) * bitcast<f32>(blob_device_buffer[block + (i + 32u)]) <
        limit) {
      bits = bits | (1u << i);
    }
  }
  return bits;
}

fn blob_device_lower(block: u32, x: array<f32, 3>, node: u32, least: ptr<function, f32>,
    next: ptr<function, u32>) -> u32 {
  var bits: u32 = 0u;
  for (var i: u32 = 0u; i < 8u; i += 1u) {
    let difference: f32 = blob_device_difference(block, i, x);
    let k: u32 = blob_device_buffer[block + (i + 40u)];
    if (difference * bitcast<f32>(blob_device_buffer[block + (i + 32u)]) < 1.0f) {
      bits = bits | (1u << i);
    }
    if (difference < (*least) || ((difference == (*least) && (*next) != node) && k < (*next))) {
      (*least) = difference;
      (*next) = k;
    }
  }
  return bits;
}

fn blob_device_holds(block: u32, k: u32) -> i32 {
  var found: i32 = 0;
  for (var i: u32 = 0u; i < 8u; i += 1u) {
    if (blob_device_buffer[block + (i + 40u)] == k) {
      found = 1;
    }
  }
  return found;
}

fn blob_device_weigh_against(block: u32, x: array<f32, 3>, part: ptr<function, array<f32, 3>>) ->
    f32 {
  var psi: blob_device_eight;
  var along_x: blob_device_eight;
  var along_y: blob_device_eight;
  var along_z: blob_device_eight;
  for (var i: u32 = 0u; i < 8u; i += 1u) {
    let inverse_tau: f32 = bitcast<f32>(blob_device_buffer[block + (i + 32u)]);
    let t: f32 = blob_device_difference(block, i, x) * inverse_tau;
    let s: f32 = blob_device_lesser(blob_device_greater(0.5f + 0.5f * t, 0.0f), 1.0f);
    let sp: f32 = s * blob_device_step(s);
    let rest: f32 = 1.0f - s;
    let q: f32 = 15.0f * (rest * rest) * inverse_tau / sp;
    psi.lanes[i] = s * s * sp;
    along_x.lanes[i] = q * bitcast<f32>(blob_device_buffer[block + i]);
    along_y.lanes[i] = q * bitcast<f32>(blob_device_buffer[block + (i + 8u)]);
    along_z.lanes[i] = q * bitcast<f32>(blob_device_buffer[block + (i + 16u)]);
  }
  (*part)[0] = blob_device_total(along_x);
  (*part)[1] = blob_device_total(along_y);
  (*part)[2] = blob_device_total(along_z);
  return psi.lanes[0] * psi.lanes[2] * (psi.lanes[1] * psi.lanes[3]) *
      (psi.lanes[4] * psi.lanes[6] * (psi.lanes[5] * psi.lanes[7]));
}

fn blob_device_least_exponent(first: u32, count: u32, at: array<f32, 3>) -> f32 {
  var least: f32 = 3e38f;
  var d: array<f32, 3>;
  for (var b: u32 = 0u; b < count; b += 1u) {
    for (var i: u32 = 0u; i < 8u; i += 1u) {
      let blob: u32 = first + BLOB_DEVICE_BLOB_WORDS * b + i;
      let u: f32 = blob_device_exponent(blob, at, &d);
      if (bitcast<f32>(blob_device_buffer[blob + 32u]) > 0.0f) {
        least = blob_device_lesser(u, least);
      }
    }
  }
  return least;
}

fn blob_device_sum_blobs(phi: u32, first: u32, count: u32, at: array<f32, 3>, shift: f32,
    lane: ptr<function, blob_device_lane>) {
  var f: blob_device_eight;
  var along_x: blob_device_eight;
  var along_y: blob_device_eight;
  var along_z: blob_device_eight;
  for (var i: u32 = 0u; i < 8u; i += 1u) {
    along_z.lanes[i] = 0.0f;
    along_y.lanes[i] = 0.0f;
    along_x.lanes[i] = 0.0f;
    f.lanes[i] = 0.0f;
  }
  for (var b: u32 = 0u; b < count; b += 1u) {
    for (var i: u32 = 0u; i < 8u; i += 1u) {
      let blob: u32 = first + BLOB_DEVICE_BLOB_WORDS * b + i;
      var d: array<f32, 3>;
      var slope: f32;
      var u: f32 = blob_device_exponent(blob, at, &d);
      u = select(u, blob_device_greater(u - shift, 0.0f), phi == 1u);
      f.lanes[i] += blob_device_term(phi, u, bitcast<f32>(blob_device_buffer[blob + 24u]),
          bitcast<f32>(blob_device_buffer[blob + 32u]), &slope);
      along_x.lanes[i] += slope * d[0];
      along_y.lanes[i] += slope * d[1];
      along_z.lanes[i] += slope * d[2];
    }
  }
  (*lane).field[0] = blob_device_total(f);
  (*lane).field[1] = blob_device_total(along_x);
  (*lane).field[2] = blob_device_total(along_y);
  (*lane).field[3] = blob_device_total(along_z);
}

fn blob_device_evaluate(v: blob_device_vessel, node: blob_device_node) -> blob_device_lane {
  let count: u32 = blob_device_buffer[node.record + 9u];
  let first: u32 = v.words + v.blobs + BLOB_DEVICE_BLOB_WORDS *
      blob_device_buffer[node.record + 8u];
  var lane: blob_device_lane;
  var at: array<f32, 3>;
  at[0] = node.x[0] + bitcast<f32>(blob_device_buffer[node.record + 4u]);
  at[1] = node.x[1] + bitcast<f32>(blob_device_buffer[node.record + 5u]);
  at[2] = node.x[2] + bitcast<f32>(blob_device_buffer[node.record + 6u]);
  lane.shift = 0.0f;
  if (v.phi == 1u && count > 0u) {
    lane.shift = blob_device_least_exponent(first, count, at);
  }
  lane.radius = bitcast<f32>(blob_device_buffer[node.record + 3u]);
  blob_device_sum_blobs(v.phi, first, count, at, lane.shift, &lane);
  return lane;
}

fn blob_device_rivals(node: blob_device_node) -> u32 {
  for (var b: u32 = 1u; b < node.blocks; b += 1u) {
    if (blob_device_below(node.neighbour + BLOB_DEVICE_NEIGHBOUR_WORDS * b, node.x, 1.0f) != 0u) {
      return BLOB_DEVICE_MANY;
    }
  }
  return blob_device_below(node.neighbour, node.x, 1.0f);
}

fn blob_device_follow(v: blob_device_vessel, place: blob_device_place, node: ptr<function, u32>) ->
    blob_device_node {
  var here: blob_device_node = blob_device_at(v, (*node), place);
  var before: u32 = (*node);
  for (var step: i32 = 0; step < 256; step += 1) {
    var next: u32 = (*node);
    var least: f32 = 0.0f;
    here.rivals = 0u;
    for (var b: u32 = 0u; b < here.blocks; b += 1u) {
      let bits: u32 = blob_device_lower(here.neighbour + BLOB_DEVICE_NEIGHBOUR_WORDS * b, here.x,
          (*node), &least, &next);
      here.rivals = select(select(here.rivals, BLOB_DEVICE_MANY, bits != 0u), bits, b == 0u);
    }
    if (next == (*node) || next == before) {
      return here;
    }
    before = (*node);
    (*node) = next;
    here = blob_device_at(v, next, place);
  }
  here.rivals = blob_device_rivals(here);
  return here;
}

fn blob_device_add_active(blending: ptr<function, blob_device_active>, k: u32) {
  for (var i: i32 = 0; i < (*blending).count; i += 1) {
    if ((*blending).nodes[i] == k) {
      return;
    }
  }
  if ((*blending).count < BLOB_DEVICE_MOST_ACTIVE) {
    (*blending).nodes[(*blending).count] = k;
    (*blending).count += 1;
  }
}

fn blob_device_is_neighbour(v: blob_device_vessel, node: u32, k: u32) -> i32 {
  let record: u32 = v.words + v.nodes + BLOB_DEVICE_NODE_WORDS * node;
  let first: u32 = v.words + v.neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS *
      blob_device_buffer[record + 10u];
  for (var b: u32 = 0u; b < blob_device_buffer[record + 11u]; b += 1u) {
    if (blob_device_holds(first + BLOB_DEVICE_NEIGHBOUR_WORDS * b, k) != 0) {
      return 1;
    }
  }
  return 0;
}

fn blob_device_weigh(v: blob_device_vessel, index: u32, node: blob_device_node,
    blending: ptr<function, blob_device_active>, gradient: ptr<function, array<f32, 3>>) -> f32 {
  var number: u32;
  var u: f32 = 1.0f;
  var part: array<f32, 3>;
  (*gradient)[0] = 0.0f;
  (*gradient)[1] = 0.0f;
  (*gradient)[2] = 0.0f;
  for (var b: u32 = 0u; b < node.blocks; b += 1u) {
    let block: u32 = node.neighbour + BLOB_DEVICE_NEIGHBOUR_WORDS * b;
    var rivals: u32 = blob_device_below(block, node.x, 1.0f);
    if (rivals == 0u) {
      continue;
    }
    u *= blob_device_weigh_against(block, node.x, &part);
    if (!(u > 1e-20f)) {
      return 0.0f;
    }
    (*gradient)[0] += part[0];
    (*gradient)[1] += part[1];
    (*gradient)[2] += part[2];
    number = blob_device_count(rivals);
    for (var i: u32 = 0u; i < number; i += 1u) {
      let k: u32 = blob_device_buffer[block + (blob_device_first(rivals) + 40u)];
      rivals = rivals & (rivals - 1u);
      if (index == (*blending).nodes[0] || blob_device_is_neighbour(v, (*blending).nodes[0], k) ==
          0) {
        blob_device_add_active(blending, k);
      }
    }
  }
  (*gradient)[0] *= u;
  (*gradient)[1] *= u;
  (*gradient)[2] *= u;
  return u;
}

fn blob_device_share_shift(first: ptr<function, f32>, second: f32, of_first: ptr<function, f32>,
    of_second: ptr<function, f32>) {
  let difference: f32 = (*first) - second;
  (*of_first) = 1.0f;
  (*of_second) = 1.0f;
  if (difference <= 60.0f) {
    (*of_second) = blob_device_exp(difference);
  } else {
    (*first) = second;
    (*of_first) = blob_device_exp(-difference);
  }
}

fn blob_device_add(v: blob_device_vessel, own: blob_device_lane, u: f32, gradient: array<f32, 3>,
    sum: ptr<function, blob_device_mixture>) {
  var of_sum: f32 = 1.0f;
  var of_own: f32 = 1.0f;
  var above: f32;
  if ((*sum).is_empty != 0) {
    (*sum).is_empty = 0;
    (*sum).f0 = own.field[0];
    (*sum).shift = own.shift;
  } else if (v.phi == 1u) {
    var copy_1 = (*sum).shift;
    blob_device_share_shift(&copy_1, own.shift, &of_sum, &of_own);
    (*sum).shift = copy_1;
    (*sum).f0 *= of_sum;
    (*sum).excess[0] *= of_sum;
    (*sum).field[0] *= of_sum;
    (*sum).excess[1] *= of_sum;
    (*sum).field[1] *= of_sum;
    (*sum).excess[2] *= of_sum;
    (*sum).field[2] *= of_sum;
    (*sum).excess[3] *= of_sum;
    (*sum).field[3] *= of_sum;
  }
  above = of_own * own.field[0] - (*sum).f0;
  (*sum).weight[0] += u;
  (*sum).excess[0] += above * u;
  (*sum).field[0] += u * (of_own * own.field[0]);
  (*sum).weight[1] += gradient[0];
  (*sum).excess[1] += above * gradient[0];
  (*sum).field[1] += u * (of_own * own.field[1]);
  (*sum).weight[2] += gradient[1];
  (*sum).excess[2] += above * gradient[1];
  (*sum).field[2] += u * (of_own * own.field[2]);
  (*sum).weight[3] += gradient[2];
  (*sum).excess[3] += above * gradient[2];
  (*sum).field[3] += u * (of_own * own.field[3]);
  (*sum).radius += u * own.radius;
}

fn blob_device_clear(sum: ptr<function, blob_device_mixture>) {
  (*sum).field[0] = 0.0f;
  (*sum).excess[0] = 0.0f;
  (*sum).weight[0] = 0.0f;
  (*sum).field[1] = 0.0f;
  (*sum).excess[1] = 0.0f;
  (*sum).weight[1] = 0.0f;
  (*sum).field[2] = 0.0f;
  (*sum).excess[2] = 0.0f;
  (*sum).weight[2] = 0.0f;
  (*sum).field[3] = 0.0f;
  (*sum).excess[3] = 0.0f;
  (*sum).weight[3] = 0.0f;
  (*sum).shift = 0.0f;
  (*sum).f0 = 0.0f;
  (*sum).radius = 0.0f;
  (*sum).is_empty = 1;
}

fn blob_device_quotient(sum: blob_device_mixture) -> blob_device_lane {
  let inverse: f32 = 1.0f / sum.weight[0];
  let excess: f32 = sum.excess[0] * inverse;
  var lane: blob_device_lane;
  lane.field[0] = sum.f0 + excess;
  lane.field[1] = (sum.field[1] + (sum.excess[1] - excess * sum.weight[1])) * inverse;
  lane.field[2] = (sum.field[2] + (sum.excess[2] - excess * sum.weight[2])) * inverse;
  lane.field[3] = (sum.field[3] + (sum.excess[3] - excess * sum.weight[3])) * inverse;
  lane.shift = sum.shift;
  lane.radius = sum.radius * inverse;
  return lane;
}

fn blob_device_blend_all(v: blob_device_vessel, place: blob_device_place, start: u32,
    lane: ptr<function, blob_device_lane>) {
  var blending: blob_device_active;
  var sum: blob_device_mixture;
  var gradient: array<f32, 3>;
  blob_device_clear(&sum);
  blending.nodes[0] = start;
  blending.count = 1;
  for (var n: i32 = 0; n < blending.count; n += 1) {
    let before: i32 = blending.count;
    let node: blob_device_node = blob_device_at(v, blending.nodes[n], place);
    let u: f32 = blob_device_weigh(v, blending.nodes[n], node, &blending, &gradient);
    if (u > 0.0f) {
      var own: blob_device_lane;
      if (n == 0) {
        own = (*lane);
      } else {
        own = blob_device_evaluate(v, node);
      }
      blob_device_add(v, own, u, gradient, &sum);
    } else {
      blending.count = before;
    }
  }
  if (sum.is_empty == 0) {
    (*lane) = blob_device_quotient(sum);
  }
}

fn blob_device_pair(v: blob_device_vessel, node: u32, other: blob_device_node, rivals: u32, t: f32)
    -> i32 {
  var number: u32;
  var rest: u32 = rivals;
  if (rivals == BLOB_DEVICE_MANY || !(t > -0.999f)) {
    return 0;
  }
  if ((rivals & (rivals - 1u)) == 0u) {
    if (rivals == 0u || blob_device_buffer[other.neighbour + (blob_device_first(rivals) + 40u)] ==
        node) {
      return 1;
    }
  }
  number = blob_device_count(rivals);
  for (var i: u32 = 0u; i < number; i += 1u) {
    let k: u32 = blob_device_buffer[other.neighbour + (blob_device_first(rest) + 40u)];
    rest = rest & (rest - 1u);
    if (k != node && blob_device_is_neighbour(v, node, k) == 0) {
      return 0;
    }
  }
  return 2;
}

fn blob_device_mix(v: blob_device_vessel, rival: u32, t: f32, other: blob_device_lane,
    lane: ptr<function, blob_device_lane>) {
  let s: f32 = 0.5f + 0.5f * t;
  let rest: f32 = 1.0f - s;
  let psi: f32 = s * s * s * blob_device_step(s);
  let slope: f32 = 15.0f * (s * s * (rest * rest)) * bitcast<f32>(blob_device_buffer[rival + 32u]);
  var of_own: f32 = 1.0f;
  var of_other: f32 = 1.0f;
  var excess: array<f32, 4>;
  if (v.phi == 1u) {
    var copy_1 = (*lane).shift;
    blob_device_share_shift(&copy_1, other.shift, &of_own, &of_other);
    (*lane).shift = copy_1;
  }
  excess[0] = (*lane).field[0] * of_own - other.field[0] * of_other;
  excess[1] = (*lane).field[1] * of_own - other.field[1] * of_other;
  excess[2] = (*lane).field[2] * of_own - other.field[2] * of_other;
  excess[3] = (*lane).field[3] * of_own - other.field[3] * of_other;
  if (v.phi == 1u) {
    let other_psi: f32 = rest * rest * rest * blob_device_step(rest);
    (*lane).field[0] = psi * ((*lane).field[0] * of_own) + other_psi * (other.field[0] * of_other);
    (*lane).field[1] = psi * ((*lane).field[1] * of_own) + other_psi * (other.field[1] * of_other);
    (*lane).field[2] = psi * ((*lane).field[2] * of_own) + other_psi * (other.field[2] * of_other);
    (*lane).field[3] = psi * ((*lane).field[3] * of_own) + other_psi * (other.field[3] * of_other);
  } else {
    (*lane).field[0] = other.field[0] * of_other + psi * excess[0];
    (*lane).field[1] = other.field[1] * of_other + psi * excess[1];
    (*lane).field[2] = other.field[2] * of_other + psi * excess[2];
    (*lane).field[3] = other.field[3] * of_other + psi * excess[3];
  }
  (*lane).field[1] += slope * excess[0] * bitcast<f32>(blob_device_buffer[rival + u32(8 * 0)]);
  (*lane).field[2] += slope * excess[0] * bitcast<f32>(blob_device_buffer[rival + u32(8 * 1)]);
  (*lane).field[3] += slope * excess[0] * bitcast<f32>(blob_device_buffer[rival + u32(8 * 2)]);
  (*lane).radius = other.radius + psi * ((*lane).radius - other.radius);
}

fn blob_device_mix_two(v: blob_device_vessel, rival: u32, t: f32, node: blob_device_node,
    other: blob_device_lane, lane: ptr<function, blob_device_lane>) {
  let s: f32 = 0.5f + 0.5f * t;
  let rest: f32 = 1.0f - s;
  let sp: f32 = s * blob_device_step(s);
  let u: f32 = s * s * sp;
  let q: f32 = 15.0f * (rest * rest) * bitcast<f32>(blob_device_buffer[rival + 32u]) / sp;
  let own: blob_device_lane = (*lane);
  var sum: blob_device_mixture;
  var gradient: array<f32, 3>;
  var product: f32;
  blob_device_clear(&sum);
  gradient[0] = u * (q * bitcast<f32>(blob_device_buffer[rival + u32(8 * 0)]));
  gradient[1] = u * (q * bitcast<f32>(blob_device_buffer[rival + u32(8 * 1)]));
  gradient[2] = u * (q * bitcast<f32>(blob_device_buffer[rival + u32(8 * 2)]));
  blob_device_add(v, own, u, gradient, &sum);
  product = blob_device_weigh_against(node.neighbour, node.x, &gradient);
  if (product > 1e-20f) {
    gradient[0] *= product;
    gradient[1] *= product;
    gradient[2] *= product;
    blob_device_add(v, other, product, gradient, &sum);
  }
  (*lane) = blob_device_quotient(sum);
}

fn blob_device_blend_one(v: blob_device_vessel, place: blob_device_place, index: u32,
    node: blob_device_node, number: u32, lane: ptr<function, blob_device_lane>) -> i32 {
  let rival: u32 = node.neighbour + number;
  let t: f32 = blob_device_difference(rival, 0u, node.x) *
      bitcast<f32>(blob_device_buffer[rival + 32u]);
  let other: blob_device_node = blob_device_at(v, blob_device_buffer[rival + 40u], place);
  let kind: i32 = blob_device_pair(v, index, other, blob_device_rivals(other), t);
  var second: blob_device_lane;
  if (kind == 0) {
    return 0;
  }
  second = blob_device_evaluate(v, other);
  if (kind == 1) {
    blob_device_mix(v, rival, t, second, lane);
  } else {
    blob_device_mix_two(v, rival, t, other, second, lane);
  }
  return 1;
}

fn blob_device_blend(v: blob_device_vessel, place: blob_device_place, index: u32,
    node: blob_device_node, lane: ptr<function, blob_device_lane>) {
  let rivals: u32 = node.rivals;
  if (rivals == 0u) {
    return;
  }
  if ((rivals & (rivals - 1u)) != 0u || blob_device_blend_one(v, place, index, node,
      blob_device_first(rivals), lane) == 0) {
    blob_device_blend_all(v, place, index, lane);
  }
}

fn blob_device_level(phi: u32, f: f32, shift: f32, relative: f32, slope: ptr<function, f32>) -> f32
    {
  var h: f32;
  if (phi == 1u) {
    (*slope) = relative;
    return shift - blob_device_log(f);
  }
  h = select(0.0f - sqrt(f), sqrt(1.0f / f), phi == 0u);
  (*slope) = select(-0.5f, 0.5f, phi == 0u) * h * relative;
  return h;
}

fn blob_device_wall(difference: f32, slope: f32, radius: f32, inside: i32) -> f32 {
  let d: f32 = select(difference, -difference, difference < 0.0f);
  let gr: f32 = slope * radius;
  let s: f32 = sqrt(d * d + gr * gr);
  let t: f32 = gr + s;
  if (!(d > 0.0f)) {
    return 0.0f;
  }
  return d * (t + d) * select(1.0f, -radius, inside != 0) / (t * select(slope, d + s, inside != 0));
}

fn blob_device_finish(v: blob_device_vessel, lane: blob_device_lane, at: array<f32, 3>,
    sample: ptr<function, blob_device_sample>) {
  let f: f32 = lane.field[0];
  let inverse_f: f32 = 1.0f / f;
  let to_centre: f32 = blob_device_norm(at);
  let scale: f32 = select(select(blob_device_exp(-lane.shift), 0.0f, lane.shift > 87.0f), 1.0f,
      v.phi != 1u);
  var e: array<f32, 3>;
  var length: f32;
  var h: f32;
  var slope: f32;
  var inside: i32;
  (*sample).value = f * scale;
  e[0] = lane.field[1] * inverse_f;
  (*sample).gradient[0] = lane.field[1] * scale;
  e[1] = lane.field[2] * inverse_f;
  (*sample).gradient[1] = lane.field[2] * scale;
  e[2] = lane.field[3] * inverse_f;
  (*sample).gradient[2] = lane.field[3] * scale;
  inside = select(0, 1, (*sample).value > v.level);
  length = blob_device_norm(e);
  h = blob_device_level(v.phi, f, lane.shift, length, &slope);
  (*sample).distance = blob_device_wall(v.transformed_level - h, slope, lane.radius, inside);
  if (inside == 0) {
    (*sample).distance = blob_device_lesser((*sample).distance, to_centre + lane.radius);
    if (!(f > 1e-20f)) {
      (*sample).distance = blob_device_greater(to_centre - lane.radius, 0.0f);
      e[0] = -at[0];
      e[1] = -at[1];
      e[2] = -at[2];
      length = to_centre;
    }
  }
  (*sample).normal[0] = select(0.0f, e[0] * (-1.0f / length), length > 0.0f);
  (*sample).normal[1] = select(0.0f, e[1] * (-1.0f / length), length > 0.0f);
  (*sample).normal[2] = select(0.0f, e[2] * (-1.0f / length), length > 0.0f);
  (*sample).state = select(0u, BLOB_DEVICE_INSIDE, inside != 0);
}

fn blob_device_is_out_of_range(node: blob_device_node, sample: ptr<function, blob_device_sample>) ->
    i32 {
  let most: f32 = 1e9f;
  var length: f32;
  if (((((node.x[0] <= most && node.x[0] >= -most) && node.x[1] <= most) && node.x[1] >= -most) &&
      node.x[2] <= most) && node.x[2] >= -most) {
    return 0;
  }
  length = blob_device_norm(node.x);
  (*sample).value = select(select(length, 0.0f, length > 0.0f), 0.0f, length - length == 0.0f);
  (*sample).distance = length - bitcast<f32>(blob_device_buffer[node.record + 3u]);
  (*sample).gradient[0] = (*sample).value;
  (*sample).normal[0] = select((*sample).value, node.x[0] / length, length > 0.0f && length <=
      3e38f);
  (*sample).gradient[1] = (*sample).value;
  (*sample).normal[1] = select((*sample).value, node.x[1] / length, length > 0.0f && length <=
      3e38f);
  (*sample).gradient[2] = (*sample).value;
  (*sample).normal[2] = select((*sample).value, node.x[2] / length, length > 0.0f && length <=
      3e38f);
  (*sample).state = 0u;
  return 1;
}

fn blob_device_enter(v: blob_device_vessel, flags: u32, place: blob_device_place,
    cursor: ptr<function, u32>, node: ptr<function, blob_device_node>, sample: ptr<function,
    blob_device_sample>) -> i32 {
  (*node) = blob_device_at(v, (*cursor), place);
  if (blob_device_is_out_of_range((*node), sample) != 0) {
    (*sample).node = (*cursor);
    return 0;
  }
  if ((flags & BLOB_DEVICE_HOLD) == 0u) {
    (*node) = blob_device_follow(v, place, cursor);
  } else {
    (*node).rivals = blob_device_rivals((*node));
  }
  return 1;
}

fn blob_device_sample_at(v: blob_device_vessel, flags: u32, place: blob_device_place,
    cursor: ptr<function, u32>, sample: ptr<function, blob_device_sample>) -> i32 {
  var node: blob_device_node;
  var lane: blob_device_lane;
  if (blob_device_enter(v, flags, place, cursor, &node, sample) == 0) {
    return 0;
  }
  lane = blob_device_evaluate(v, node);
  if ((flags & BLOB_DEVICE_LOCAL) == 0u) {
    blob_device_blend(v, place, (*cursor), node, &lane);
  }
  blob_device_finish(v, lane, node.x, sample);
  (*sample).node = (*cursor);
  return 1;
}

fn blob_device_query(words: u32, vessel: u32, flags: u32, point: array<f32, 3>,
    cursor: ptr<function, u32>, sample: ptr<function, blob_device_sample>) {
  let v: blob_device_vessel = blob_device_open(words, vessel);
  let place: blob_device_place = blob_device_place_at(point);
  if ((*cursor) >= v.node_count) {
    (*cursor) = blob_device_locate(v, place);
  }
  blob_device_sample_at(v, flags, place, cursor, sample);
}

fn blob_device_dot(a: array<f32, 3>, b: array<f32, 3>) -> f32 {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

fn blob_device_size(x: f32) -> f32 {
  return select(x, -x, x < 0.0f);
}

fn blob_device_cross(a: array<f32, 3>, b: array<f32, 3>, result: ptr<function, array<f32, 3>>) {
  (*result)[0] = a[1] * b[2] - a[2] * b[1];
  (*result)[1] = a[2] * b[0] - a[0] * b[2];
  (*result)[2] = a[0] * b[1] - a[1] * b[0];
}

fn blob_device_along(a: array<f32, 3>, s: f32, b: array<f32, 3>, result: ptr<function, array<f32,
    3>>) {
  (*result)[0] = a[0] + s * b[0];
  (*result)[1] = a[1] + s * b[1];
  (*result)[2] = a[2] + s * b[2];
}

fn blob_device_perpendicular(a: array<f32, 3>, result: ptr<function, array<f32, 3>>) {
  let x: f32 = blob_device_size(a[0]);
  let y: f32 = blob_device_size(a[1]);
  let z: f32 = blob_device_size(a[2]);
  var axis: array<f32, 3>;
  var inverse: f32;
  axis[0] = 0.0f;
  axis[1] = 0.0f;
  axis[2] = 0.0f;
  if (x <= y && x <= z) {
    axis[0] = 1.0f;
  } else if (y <= z) {
    axis[1] = 1.0f;
  } else {
    axis[2] = 1.0f;
  }
  blob_device_cross(a, axis, result);
  inverse = 1.0f / blob_device_norm((*result));
  (*result)[0] = (*result)[0] * inverse;
  (*result)[1] = (*result)[1] * inverse;
  (*result)[2] = (*result)[2] * inverse;
}

fn blob_device_turn(s: blob_device_search, a: array<f32, 3>, result: ptr<function, array<f32, 3>>) {
  (*result)[0] = s.diagonal[0] * a[0] + s.mixed[0] * a[1] + s.mixed[1] * a[2];
  (*result)[1] = s.mixed[0] * a[0] + s.diagonal[1] * a[1] + s.mixed[2] * a[2];
  (*result)[2] = s.mixed[1] * a[0] + s.mixed[2] * a[1] + s.diagonal[2] * a[2];
}

fn blob_device_add_products(s: ptr<function, blob_device_search>, r: array<f32, 3>, m: array<f32,
    3>) {
  (*s).diagonal[0] += 2.0f * (r[0] * m[0]);
  (*s).diagonal[1] += 2.0f * (r[1] * m[1]);
  (*s).diagonal[2] += 2.0f * (r[2] * m[2]);
  (*s).mixed[0] += r[0] * m[1] + m[0] * r[1];
  (*s).mixed[1] += r[0] * m[2] + m[0] * r[2];
  (*s).mixed[2] += r[1] * m[2] + m[1] * r[2];
}

fn blob_device_shape(s: ptr<function, blob_device_search>, inverse_step: f32) {
  var along_first: array<f32, 3>;
  var along_second: array<f32, 3>;
  var r: array<f32, 3>;
  along_first[0] = ((*s).turned[0] - (*s).best.normal[0]) * inverse_step;
  along_second[0] = ((*s).here.normal[0] - (*s).best.normal[0]) * inverse_step;
  (*s).mixed[0] = 0.0f;
  (*s).diagonal[0] = 0.0f;
  along_first[1] = ((*s).turned[1] - (*s).best.normal[1]) * inverse_step;
  along_second[1] = ((*s).here.normal[1] - (*s).best.normal[1]) * inverse_step;
  (*s).mixed[1] = 0.0f;
  (*s).diagonal[1] = 0.0f;
  along_first[2] = ((*s).turned[2] - (*s).best.normal[2]) * inverse_step;
  along_second[2] = ((*s).here.normal[2] - (*s).best.normal[2]) * inverse_step;
  (*s).mixed[2] = 0.0f;
  (*s).diagonal[2] = 0.0f;
  r[0] = 0.5f * blob_device_dot(along_first, (*s).first) * (*s).first[0] + 0.5f *
      (blob_device_dot(along_first, (*s).second) + blob_device_dot(along_second, (*s).first)) *
      (*s).second[0];
  r[1] = 0.5f * blob_device_dot(along_first, (*s).first) * (*s).first[1] + 0.5f *
      (blob_device_dot(along_first, (*s).second) + blob_device_dot(along_second, (*s).first)) *
      (*s).second[1];
  r[2] = 0.5f * blob_device_dot(along_first, (*s).first) * (*s).first[2] + 0.5f *
      (blob_device_dot(along_first, (*s).second) + blob_device_dot(along_second, (*s).first)) *
      (*s).second[2];
  blob_device_add_products(s, r, (*s).first);
  r[0] = 0.5f * blob_device_dot(along_second, (*s).second) * (*s).second[0];
  r[1] = 0.5f * blob_device_dot(along_second, (*s).second) * (*s).second[1];
  r[2] = 0.5f * blob_device_dot(along_second, (*s).second) * (*s).second[2];
  blob_device_add_products(s, r, (*s).second);
}

fn blob_device_bend(s: ptr<function, blob_device_search>, moved: array<f32, 3>, turn: array<f32, 3>)
    {
  let square: f32 = blob_device_dot(moved, moved);
  var missing: array<f32, 3>;
  var r: array<f32, 3>;
  var inverse: f32;
  var part: f32;
  if (!(square > 0.0f)) {
    return;
  }
  inverse = 1.0f / square;
  blob_device_turn((*s), moved, &missing);
  missing[0] = turn[0] - missing[0];
  missing[1] = turn[1] - missing[1];
  missing[2] = turn[2] - missing[2];
  part = 0.5f * inverse * blob_device_dot(missing, moved);
  r[0] = inverse * (missing[0] - part * moved[0]);
  r[1] = inverse * (missing[1] - part * moved[1]);
  r[2] = inverse * (missing[2] - part * moved[2]);
  blob_device_add_products(s, r, moved);
}

fn blob_device_part(s: blob_device_search, part: f32, eigenvalue: f32) -> f32 {
  let flat: f32 = 0.02f;
  let leave: f32 = 0.1f;
  if (eigenvalue < -flat && blob_device_size(part) < s.tolerance) {
    return leave * s.radius;
  }
  return part / blob_device_greater(blob_device_size(eigenvalue), flat);
}

fn blob_device_find_step(s: ptr<function, blob_device_search>) {
  let valley: f32 = 0.2f;
  let doubted: f32 = 0.2f;
  let longest: f32 = 0.5f * (*s).radius;
  var of_first: array<f32, 3>;
  var of_second: array<f32, 3>;
  var a: f32;
  var b: f32;
  var c: f32;
  var t1: f32;
  var t2: f32;
  var x: f32;
  var y: f32;
  var distance: f32;
  var share: f32;
  var copy_1 = (*s).first;
  blob_device_perpendicular((*s).best.normal, &copy_1);
  (*s).first = copy_1;
  var copy_2 = (*s).second;
  blob_device_cross((*s).best.normal, (*s).first, &copy_2);
  (*s).second = copy_2;
  blob_device_turn((*s), (*s).first, &of_first);
  blob_device_turn((*s), (*s).second, &of_second);
  distance = (*s).best.distance - blob_device_dot((*s).best.at, (*s).best.normal);
  a = 1.0f + distance * blob_device_dot((*s).first, of_first);
  b = distance * blob_device_dot((*s).first, of_second);
  c = 1.0f + distance * blob_device_dot((*s).second, of_second);
  t1 = -blob_device_dot((*s).first, (*s).best.at);
  t2 = -blob_device_dot((*s).second, (*s).best.at);
  if (a > valley && (a - valley) * (c - valley) > b * b) {
    let inverse: f32 = 1.0f / (a * c - b * b);
    x = inverse * (c * t1 - b * t2);
    y = inverse * (a * t2 - b * t1);
  } else {
    let mean: f32 = 0.5f * (a + c);
    let spread: f32 = 0.5f * (a - c);
    let root: f32 = sqrt(spread * spread + b * b);
    let turn: f32 = select(1.0f, spread / root, root > 0.0f);
    let cosine: f32 = sqrt(blob_device_greater(0.5f * (1.0f + turn), 0.0f));
    let positive: f32 = sqrt(blob_device_greater(0.5f * (1.0f - turn), 0.0f));
    let sine: f32 = select(positive, -positive, b < 0.0f);
    let p1: f32 = blob_device_part((*s), cosine * t1 + sine * t2, mean + root);
    let p2: f32 = blob_device_part((*s), cosine * t2 - sine * t1, mean - root);
    x = cosine * p1 - sine * p2;
    y = sine * p1 + cosine * p2;
  }
  (*s).length = sqrt(x * x + y * y);
  share = select(1.0f, longest / (*s).length, (*s).length > longest);
  x = x * share;
  y = y * share;
  (*s).length = (*s).length * share;
  (*s).step[0] = x * (*s).first[0] + y * (*s).second[0];
  (*s).step[1] = x * (*s).first[1] + y * (*s).second[1];
  (*s).step[2] = x * (*s).first[2] + y * (*s).second[2];
  blob_device_turn((*s), (*s).step, &of_first);
  (*s).sag = 0.5f * blob_device_dot((*s).step, of_first);
  (*s).gain = 0.5f * (x * t1 + y * t2);
  if ((*s).is_improving == 0) {
    (*s).gain = blob_device_greater((*s).gain, 0.5f / doubted * (t1 * t1 + t2 * t2));
  }
}

fn blob_device_wait(s: ptr<function, blob_device_search>, stage: u32, share: f32, vector: array<f32,
    3>) {
  var copy_1 = (*s).here.at;
  blob_device_along((*s).best.at, share, vector, &copy_1);
  (*s).here.at = copy_1;
  (*s).here.node = (*s).best.node;
  (*s).stage = stage;
}

fn blob_device_axis(v: blob_device_vessel, node: u32, axis: ptr<function, array<f32, 3>>) {
  let record: u32 = v.words + v.nodes + BLOB_DEVICE_NODE_WORDS * node;
  let first: u32 = v.words + v.neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS *
      blob_device_buffer[record + 10u];
  var length: f32;
  (*axis)[0] = bitcast<f32>(blob_device_buffer[first + u32(8 * 0)]);
  (*axis)[1] = bitcast<f32>(blob_device_buffer[first + u32(8 * 1)]);
  (*axis)[2] = bitcast<f32>(blob_device_buffer[first + u32(8 * 2)]);
  length = blob_device_norm((*axis));
  (*axis)[0] = select(select(0.0f, 1.0f, 0 == 0), (*axis)[0] / length, length > 0.0f);
  (*axis)[1] = select(select(0.0f, 1.0f, 1 == 0), (*axis)[1] / length, length > 0.0f);
  (*axis)[2] = select(select(0.0f, 1.0f, 2 == 0), (*axis)[2] / length, length > 0.0f);
}

fn blob_device_go_beside(s: ptr<function, blob_device_search>) {
  let across: f32 = 0.7f * (*s).radius;
  let signed_length: f32 = select(-across, across, ((*s).tried & 1) == 0);
  (*s).here.at[0] = signed_length * select((*s).second[0], (*s).first[0], (*s).tried < 2);
  (*s).here.at[1] = signed_length * select((*s).second[1], (*s).first[1], (*s).tried < 2);
  (*s).here.at[2] = signed_length * select((*s).second[2], (*s).first[2], (*s).tried < 2);
  (*s).stage = BLOB_DEVICE_BESIDE;
}

fn blob_device_reach(s: blob_device_search) -> f32 {
  return 0.002f * s.radius;
}

fn blob_device_curve(s: ptr<function, blob_device_search>) {
  let reach: f32 = blob_device_reach((*s));
  var copy_1 = (*s).first;
  blob_device_perpendicular((*s).best.normal, &copy_1);
  (*s).first = copy_1;
  var copy_2 = (*s).second;
  blob_device_cross((*s).best.normal, (*s).first, &copy_2);
  (*s).second = copy_2;
  (*s).tried = 0;
  blob_device_wait(s, BLOB_DEVICE_CURVING, reach, (*s).first);
}

fn blob_device_go_on(s: ptr<function, blob_device_search>) {
  let depth: f32 = (*s).best.distance + (*s).share * (*s).share * (*s).sag;
  blob_device_wait(s, BLOB_DEVICE_GLIDING, (*s).share, (*s).step);
  var copy_1 = (*s).here.at;
  blob_device_along((*s).here.at, -depth, (*s).best.normal, &copy_1);
  (*s).here.at = copy_1;
}

fn blob_device_project(v: blob_device_vessel, s: ptr<function, blob_device_search>) -> i32 {
  let is_near: i32 = select(0, 1, blob_device_size((*s).here.distance) <= 0.5f * (*s).tolerance);
  var axis: array<f32, 3>;
  if (!((*s).here.value > 1e-20f) && !(blob_device_size((*s).here.distance) > 0.0f)) {
    (*s).stage = BLOB_DEVICE_STOPPED;
    return 0;
  }
  if (!(blob_device_dot((*s).here.normal, (*s).here.normal) > 0.0f)) {
    blob_device_axis(v, (*s).here.node, &axis);
    var copy_1 = (*s).here.normal;
    blob_device_perpendicular(axis, &copy_1);
    (*s).here.normal = copy_1;
  }
  var copy_2 = (*s).here.at;
  blob_device_along((*s).here.at, -(*s).here.distance, (*s).here.normal, &copy_2);
  (*s).here.at = copy_2;
  (*s).here.distance = 0.0f;
  (*s).stage = BLOB_DEVICE_PROJECTING;
  return is_near;
}

fn blob_device_improve(v: blob_device_vessel, s: ptr<function, blob_device_search>) {
  let most_halvings: i32 = 8;
  let stalled: f32 = 1e-3f;
  var length: f32;
  if (blob_device_project(v, s) == 0) {
    return;
  }
  length = blob_device_norm((*s).here.at);
  if ((*s).is_improving == 0 || length < (*s).nearest) {
    (*s).is_improving = 1;
    (*s).nearest = length;
    (*s).best = (*s).here;
    blob_device_curve(s);
    return;
  }
  (*s).places += 1;
  (*s).share = 0.5f * (*s).share;
  if ((*s).places < most_halvings) {
    blob_device_wait(s, BLOB_DEVICE_PROJECTING, (*s).share, (*s).step);
  } else {
    (*s).stage = select(BLOB_DEVICE_STOPPED, BLOB_DEVICE_FOUND, (*s).gain <= stalled *
        ((*s).nearest * (*s).nearest));
  }
}

fn blob_device_stop_gliding(v: blob_device_vessel, s: ptr<function, blob_device_search>) {
  (*s).here = (*s).best;
  (*s).is_improving = 0;
  blob_device_improve(v, s);
}

fn blob_device_make_step(s: ptr<function, blob_device_search>) {
  let enough: f32 = 0.1f * (*s).tolerance;
  let slow: f32 = 0.6f;
  let misjudged: f32 = 0.3f;
  let before: f32 = select((*s).length, 0.0f, (*s).steps == 0 || (*s).share < 1.0f);
  let off: f32 = (*s).best.distance;
  var length: f32;
  blob_device_find_step(s);
  (*s).share = 1.0f;
  if ((*s).is_improving != 0) {
    (*s).places = 0;
    if ((*s).length <= (*s).tolerance || (*s).gain <= enough * (*s).nearest) {
      (*s).stage = BLOB_DEVICE_FOUND;
    } else {
      blob_device_wait(s, BLOB_DEVICE_PROJECTING, 1.0f, (*s).step);
    }
    return;
  }
  var copy_1 = (*s).begun;
  blob_device_along((*s).best.at, -off, (*s).best.normal, &copy_1);
  (*s).begun = copy_1;
  (*s).before[0] = (*s).best.normal[0];
  (*s).before[1] = (*s).best.normal[1];
  (*s).before[2] = (*s).best.normal[2];
  length = blob_device_norm((*s).begun);
  (*s).reached = length + misjudged * off * off / (*s).radius;
  (*s).steps += 1;
  if (before > 0.0f && (*s).length > slow * before) {
    (*s).slow += 1;
  }
  if (off * off <= enough * (*s).radius && (*s).gain <= enough * length) {
    (*s).stage = BLOB_DEVICE_FOUND;
  } else {
    blob_device_go_on(s);
  }
}

fn blob_device_glide(v: blob_device_vessel, s: ptr<function, blob_device_search>) {
  let most_places: i32 = 12;
  let most_slow: i32 = 1;
  let shorten: f32 = 0.4f;
  let least_share: f32 = 0.1f;
  let off_wall: f32 = 0.1f * (*s).radius;
  var foot: array<f32, 3>;
  var turn: array<f32, 3>;
  blob_device_along((*s).here.at, -(*s).here.distance, (*s).here.normal, &foot);
  if ((*s).places == 0) {
    (*s).best = (*s).here;
  }
  (*s).places += 1;
  if ((*s).places > most_places || !((*s).here.value > 1e-20f)) {
    blob_device_stop_gliding(v, s);
    return;
  }
  if ((*s).steps > 0 && blob_device_norm(foot) > (*s).reached) {
    (*s).share = shorten * (*s).share;
    if ((*s).share < least_share) {
      blob_device_stop_gliding(v, s);
    } else {
      blob_device_go_on(s);
    }
    return;
  }
  (*s).best = (*s).here;
  if (blob_device_size((*s).here.distance) > off_wall) {
    blob_device_wait(s, BLOB_DEVICE_GLIDING, -(*s).here.distance, (*s).here.normal);
  } else if ((*s).steps == 0 || (*s).slow > most_slow) {
    blob_device_curve(s);
  } else {
    blob_device_along(foot, -1.0f, (*s).begun, &foot);
    blob_device_along((*s).best.normal, -1.0f, (*s).before, &turn);
    blob_device_bend(s, foot, turn);
    blob_device_make_step(s);
  }
}

fn blob_device_leave_point(v: blob_device_vessel, s: ptr<function, blob_device_search>) {
  (*s).first_distance = (*s).here.distance;
  (*s).best = (*s).here;
  if ((*s).here.value > 1e-20f) {
    blob_device_wait(s, BLOB_DEVICE_APPROACHING, -(*s).here.distance, (*s).here.normal);
  } else {
    blob_device_improve(v, s);
  }
}

fn blob_device_arrive(v: blob_device_vessel, s: ptr<function, blob_device_search>) {
  let is_deep: i32 = select(0, 1, (*s).is_inside != 0 && (*s).first_distance < -0.5f * (*s).radius);
  var axis: array<f32, 3>;
  if (is_deep != 0 && (*s).here.distance < 0.5f * (*s).first_distance) {
    blob_device_axis(v, (*s).best.node, &axis);
    var copy_1 = (*s).first;
    blob_device_perpendicular(axis, &copy_1);
    (*s).first = copy_1;
    var copy_2 = (*s).second;
    blob_device_cross(axis, (*s).first, &copy_2);
    (*s).second = copy_2;
    (*s).here.node = (*s).best.node;
    blob_device_go_beside(s);
  } else {
    blob_device_glide(v, s);
  }
}

fn blob_device_choose_side(s: ptr<function, blob_device_search>) {
  if ((*s).tried == 0 || (*s).here.distance > (*s).best.distance) {
    (*s).best = (*s).here;
  }
  (*s).tried += 1;
  (*s).here.node = (*s).best.node;
  if ((*s).tried < 4) {
    blob_device_go_beside(s);
  } else {
    blob_device_wait(s, BLOB_DEVICE_GLIDING, -(*s).best.distance, (*s).best.normal);
  }
}

fn blob_device_see_shape(s: ptr<function, blob_device_search>) {
  let reach: f32 = blob_device_reach((*s));
  (*s).tried += 1;
  if ((*s).tried == 1) {
    (*s).turned[0] = (*s).here.normal[0];
    (*s).turned[1] = (*s).here.normal[1];
    (*s).turned[2] = (*s).here.normal[2];
    blob_device_wait(s, BLOB_DEVICE_CURVING, reach, (*s).second);
  } else {
    blob_device_shape(s, 1.0f / reach);
    blob_device_make_step(s);
  }
}

fn blob_device_advance(v: blob_device_vessel, s: ptr<function, blob_device_search>,
    there: blob_device_sample) {
  (*s).here.value = there.value;
  (*s).here.distance = there.distance;
  (*s).here.node = there.node;
  (*s).here.normal[0] = there.normal[0];
  (*s).here.normal[1] = there.normal[1];
  (*s).here.normal[2] = there.normal[2];
  if ((*s).stage == BLOB_DEVICE_AT_POINT) {
    blob_device_leave_point(v, s);
  } else if ((*s).stage == BLOB_DEVICE_APPROACHING) {
    blob_device_arrive(v, s);
  } else if ((*s).stage == BLOB_DEVICE_BESIDE) {
    blob_device_choose_side(s);
  } else if ((*s).stage == BLOB_DEVICE_GLIDING) {
    blob_device_glide(v, s);
  } else if ((*s).stage == BLOB_DEVICE_CURVING) {
    blob_device_see_shape(s);
  } else {
    blob_device_improve(v, s);
  }
}

fn blob_device_begin_search(s: ptr<function, blob_device_search>, node: u32) {
  (*s).here.at[0] = 0.0f;
  (*s).here.at[1] = 0.0f;
  (*s).here.at[2] = 0.0f;
  (*s).here.node = node;
  (*s).stage = BLOB_DEVICE_AT_POINT;
  (*s).share = 1.0f;
  (*s).nearest = 0.0f;
  (*s).reached = 0.0f;
  (*s).gain = 0.0f;
  (*s).sag = 0.0f;
  (*s).length = 0.0f;
  (*s).slow = 0;
  (*s).steps = 0;
  (*s).places = 0;
  (*s).tried = 0;
  (*s).is_improving = 0;
}

fn blob_device_report(s: blob_device_search, sample: ptr<function, blob_device_sample>) {
  var foot: array<f32, 3>;
  var length: f32;
  blob_device_along(s.best.at, -s.best.distance, s.best.normal, &foot);
  length = blob_device_norm(foot);
  (*sample).distance = select(length, -length, s.is_inside != 0);
  (*sample).normal[0] = s.best.normal[0];
  (*sample).normal[1] = s.best.normal[1];
  (*sample).normal[2] = s.best.normal[2];
  if (s.stage != BLOB_DEVICE_FOUND) {
    (*sample).state = (*sample).state | BLOB_DEVICE_NOT_CONVERGED;
  }
}

fn blob_device_query_exact(words: u32, vessel: u32, flags: u32, point: array<f32, 3>,
    cursor: ptr<function, u32>, sample: ptr<function, blob_device_sample>) {
  let v: blob_device_vessel = blob_device_open(words, vessel);
  let most: i32 = 128;
  var place: blob_device_place = blob_device_place_at(point);
  var s: blob_device_search;
  if ((*cursor) >= v.node_count) {
    (*cursor) = blob_device_locate(v, place);
  }
  blob_device_begin_search(&s, (*cursor));
  for (var n: i32 = 0; n < most; n += 1) {
    var there: blob_device_sample;
    var node: u32 = s.here.node;
    var in_range: i32;
    place.step[0] = s.here.at[0];
    place.step[1] = s.here.at[1];
    place.step[2] = s.here.at[2];
    in_range = blob_device_sample_at(v, flags, place, &node, &there);
    if (n == 0) {
      (*sample) = there;
      (*cursor) = node;
      if (in_range == 0) {
        return;
      }
      s.is_inside = select(0, 1, (there.state & BLOB_DEVICE_INSIDE) != 0u);
      s.radius = bitcast<f32>(blob_device_buffer[v.words +
          (v.nodes + BLOB_DEVICE_NODE_WORDS * node + 3u)]);
      s.tolerance = 1e-5f * s.radius;
    }
    blob_device_advance(v, &s, there);
    if (s.stage >= BLOB_DEVICE_FOUND) {
      break;
    }
  }
  blob_device_report(s, sample);
}

// ---------------------------------------------------------------- kernels

// Arguments of a dispatch; groups_x is the number of its workgroups along x.
struct blob_query_batch {
  vessel: u32,
  flags: u32,
  count: u32,
  groups_x: u32,
}

// point: x, y, z of each point, mm. Cursors are read and moved. answer: distance in mm and
// outward normal; value: f and its gradient; state: BLOB_DEVICE_INSIDE and _NOT_CONVERGED.
@group(0) @binding(1) var<uniform> blob_batch: blob_query_batch;
@group(0) @binding(2) var<storage, read> blob_point: array<f32>;
@group(0) @binding(3) var<storage, read_write> blob_cursor: array<u32>;
@group(0) @binding(4) var<storage, read_write> blob_answer: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> blob_value: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> blob_state: array<u32>;

@compute @workgroup_size(64)
fn blob_query_points(@builtin(global_invocation_id) id: vec3<u32>) {
  let i = id.y * blob_batch.groups_x * 64u + id.x;
  if (i >= blob_batch.count) {
    return;
  }
  let at = array<f32, 3>(blob_point[3u * i], blob_point[3u * i + 1u], blob_point[3u * i + 2u]);
  var node = blob_cursor[i];
  var s: blob_device_sample;
  blob_device_query(0u, blob_batch.vessel, blob_batch.flags, at, &node, &s);
  blob_cursor[i] = node;
  blob_answer[i] = vec4<f32>(s.distance, s.normal[0], s.normal[1], s.normal[2]);
  blob_value[i] = vec4<f32>(s.value, s.gradient[0], s.gradient[1], s.gradient[2]);
  blob_state[i] = s.state;
}

@compute @workgroup_size(64)
fn blob_query_exact_points(@builtin(global_invocation_id) id: vec3<u32>) {
  let i = id.y * blob_batch.groups_x * 64u + id.x;
  if (i >= blob_batch.count) {
    return;
  }
  let at = array<f32, 3>(blob_point[3u * i], blob_point[3u * i + 1u], blob_point[3u * i + 2u]);
  var node = blob_cursor[i];
  var s: blob_device_sample;
  blob_device_query_exact(0u, blob_batch.vessel, blob_batch.flags, at, &node, &s);
  blob_cursor[i] = node;
  blob_answer[i] = vec4<f32>(s.distance, s.normal[0], s.normal[1], s.normal[2]);
  blob_value[i] = vec4<f32>(s.value, s.gradient[0], s.gradient[1], s.gradient[2]);
  blob_state[i] = s.state;
}
