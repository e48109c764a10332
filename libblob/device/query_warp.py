# SPDX-License-Identifier: Apache-2.0
"""libblob's query for NVIDIA Warp, with blob_query_points() and blob_query_exact_points(), a thread for each tool point.

Generated from blob_device_exact.h and the headers that it includes, which explain each function and the buffer, by
libblob/device/translate/translate.py; change those. A pointer of C into the buffer is the index of a
word here: `words` is that of the buffer's first word, 0 unless other data lie before it. Functions
return what C writes through pointers, after their result. Needs wp.where and wp.cast (Warp 1.7).
"""
import warp as wp

# as the library rounds: no multiplication and addition become one; nothing is differentiated
wp.set_module_options({"fuse_fp": False, "enable_backward": False})

BLOB_DEVICE_MAGIC = wp.constant(wp.uint32(0x5642424c))
BLOB_DEVICE_VERSION = wp.constant(wp.uint32(2))
BLOB_DEVICE_HEADER_WORDS = wp.constant(wp.uint32(4))
BLOB_DEVICE_VESSEL_WORDS = wp.constant(wp.uint32(8))
BLOB_DEVICE_NODE_WORDS = wp.constant(wp.uint32(16))
BLOB_DEVICE_NEIGHBOUR_WORDS = wp.constant(wp.uint32(48))
BLOB_DEVICE_BLOB_WORDS = wp.constant(wp.uint32(40))
BLOB_DEVICE_ALIGN_WORDS = wp.constant(wp.uint32(16))
BLOB_DEVICE_BLENDED = wp.constant(wp.uint32(0))
BLOB_DEVICE_LOCAL = wp.constant(wp.uint32(1))
BLOB_DEVICE_HOLD = wp.constant(wp.uint32(4))
BLOB_DEVICE_INSIDE = wp.constant(wp.uint32(1))
BLOB_DEVICE_NOWHERE = wp.constant(wp.uint32(0xffffffff))
BLOB_DEVICE_SIMT = wp.constant(0)
BLOB_DEVICE_WIDE = wp.constant(0)
BLOB_DEVICE_MANY = wp.constant(wp.uint32(0xffffffff))
BLOB_DEVICE_MOST_ACTIVE = wp.constant(24)
BLOB_DEVICE_AT_POINT = wp.constant(wp.uint32(0))
BLOB_DEVICE_APPROACHING = wp.constant(wp.uint32(1))
BLOB_DEVICE_BESIDE = wp.constant(wp.uint32(2))
BLOB_DEVICE_GLIDING = wp.constant(wp.uint32(3))
BLOB_DEVICE_CURVING = wp.constant(wp.uint32(4))
BLOB_DEVICE_PROJECTING = wp.constant(wp.uint32(5))
BLOB_DEVICE_FOUND = wp.constant(wp.uint32(6))
BLOB_DEVICE_STOPPED = wp.constant(wp.uint32(7))
BLOB_DEVICE_EXACT = wp.constant(wp.uint32(2))
BLOB_DEVICE_NOT_CONVERGED = wp.constant(wp.uint32(2))

blob_device_floats = wp.types.vector(length=8, dtype=wp.float32)
blob_device_nodes = wp.types.vector(length=24, dtype=wp.uint32)


@wp.struct
class blob_device_sample:
    value: wp.float32
    gradient: wp.vec3
    distance: wp.float32
    normal: wp.vec3
    node: wp.uint32
    state: wp.uint32


@wp.struct
class blob_device_vessel:
    words: wp.uint32
    phi: wp.uint32
    node_count: wp.uint32
    nodes: wp.uint32
    neighbours: wp.uint32
    blobs: wp.uint32
    level: wp.float32
    transformed_level: wp.float32


@wp.struct
class blob_device_place:
    point: wp.vec3
    step: wp.vec3


@wp.struct
class blob_device_node:
    record: wp.uint32
    neighbour: wp.uint32
    blocks: wp.uint32
    rivals: wp.uint32
    x: wp.vec3


@wp.struct
class blob_device_lane:
    field: wp.vec4
    shift: wp.float32
    radius: wp.float32


@wp.struct
class blob_device_eight:
    lanes: blob_device_floats


@wp.struct
class blob_device_active:
    nodes: blob_device_nodes
    count: wp.int32


@wp.struct
class blob_device_mixture:
    weight: wp.vec4
    excess: wp.vec4
    field: wp.vec4
    f0: wp.float32
    shift: wp.float32
    radius: wp.float32
    is_empty: wp.int32


@wp.struct
class blob_device_foot:
    at: wp.vec3
    normal: wp.vec3
    value: wp.float32
    distance: wp.float32
    node: wp.uint32


@wp.struct
class blob_device_search:
    here: blob_device_foot
    best: blob_device_foot
    first: wp.vec3
    second: wp.vec3
    diagonal: wp.vec3
    mixed: wp.vec3
    begun: wp.vec3
    before: wp.vec3
    turned: wp.vec3
    step: wp.vec3
    length: wp.float32
    sag: wp.float32
    gain: wp.float32
    share: wp.float32
    reached: wp.float32
    nearest: wp.float32
    radius: wp.float32
    tolerance: wp.float32
    first_distance: wp.float32
    stage: wp.uint32
    is_inside: wp.int32
    is_improving: wp.int32
    tried: wp.int32
    places: wp.int32
    steps: wp.int32
    slow: wp.int32


@wp.func
def blob_device_load(buffer: wp.array(dtype=wp.uint32), index: wp.uint32):
    return buffer[wp.int32(index)]


@wp.func
def blob_device_number(buffer: wp.array(dtype=wp.uint32), index: wp.uint32):
    return wp.cast(buffer[wp.int32(index)], wp.float32)


@wp.func
def blob_device_lesser(a: wp.float32, b: wp.float32):
    return wp.where(a < b, a, b)


@wp.func
def blob_device_greater(a: wp.float32, b: wp.float32):
    return wp.where(b < a, a, b)


@wp.func
def blob_device_norm(v: wp.vec3):
    return wp.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


@wp.func
def blob_device_exp(unbounded: wp.float32):
    x = wp.where(unbounded < -87.0, -87.0, wp.where(unbounded > 88.0, 88.0, unbounded))
    scaled = x * 1.44269504
    rest = scaled - wp.float32(wp.int32(scaled))
    n = wp.int32(scaled) + wp.where(rest > 0.5, 1, wp.where(rest < -0.5, -1, 0))
    r = x - wp.float32(n) * 0.693359375 - wp.float32(n) * -2.12194440e-4
    p = wp.float32(1.9875691500e-4)
    power = wp.uint32(0)
    p = p * r + 1.3981999507e-3
    p = p * r + 8.3334519073e-3
    p = p * r + 4.1665795894e-2
    p = p * r + 1.6666665459e-1
    p = p * r + 5.0000001201e-1
    power = wp.uint32(n + 127) << wp.uint32(23)
    return (p * (r * r) + (r + 1.0)) * wp.cast(power, wp.float32)


@wp.func
def blob_device_log(x: wp.float32):
    bits = wp.uint32(0)
    exponent = wp.int32(0)
    m = wp.float32(0.0)
    p = wp.float32(0.0)
    e = wp.float32(0.0)
    square = wp.float32(0.0)
    bits = wp.cast(x, wp.uint32)
    exponent = wp.int32(bits >> wp.uint32(23)) - 126
    bits = (bits & wp.uint32(0x007fffff)) | wp.uint32(0x3f000000)
    m = wp.cast(bits, wp.float32)
    if m < 0.70710678:
        exponent -= 1
        m = m + m
    m -= 1.0
    p = wp.float32(7.0376836292e-2)
    p = p * m + -1.1514610310e-1
    p = p * m + 1.1676998740e-1
    p = p * m + -1.2420140846e-1
    p = p * m + 1.4249322787e-1
    p = p * m + -1.6668057665e-1
    p = p * m + 2.0000714765e-1
    p = p * m + -2.4999993993e-1
    p = p * m + 3.3333331174e-1
    e = wp.float32(exponent)
    square = m * m
    return m + (m * square * p + e * -2.12194440e-4 - 0.5 * square) + e * 0.693359375


@wp.func
def blob_device_open(buffer: wp.array(dtype=wp.uint32), words: wp.uint32, index: wp.uint32):
    at = BLOB_DEVICE_HEADER_WORDS + BLOB_DEVICE_VESSEL_WORDS * index
    v = blob_device_vessel()
    v.words = words
    v.phi = blob_device_load(buffer, words + at)
    v.node_count = blob_device_load(buffer, words + (at + wp.uint32(1)))
    v.nodes = blob_device_load(buffer, words + (at + wp.uint32(2)))
    v.neighbours = blob_device_load(buffer, words + (at + wp.uint32(3)))
    v.blobs = blob_device_load(buffer, words + (at + wp.uint32(4)))
    v.level = blob_device_number(buffer, words + (at + wp.uint32(5)))
    v.transformed_level = blob_device_number(buffer, words + (at + wp.uint32(6)))
    return v


@wp.func
def blob_device_place_at(point: wp.vec3):
    place = blob_device_place()
    for i in range(3):
        place.point[i] = point[i]
    for i in range(3):
        place.step[i] = wp.float32(0.0)
    return place


@wp.func
def blob_device_at(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel, index: wp.uint32,
        place: blob_device_place):
    record = v.words + v.nodes + BLOB_DEVICE_NODE_WORDS * index
    x = (place.point[0] - blob_device_number(buffer, record) -
            blob_device_number(buffer, record + wp.uint32(12)) + place.step[0])
    y = (place.point[1] - blob_device_number(buffer, record + wp.uint32(1)) -
            blob_device_number(buffer, record + wp.uint32(13)) + place.step[1])
    z = (place.point[2] - blob_device_number(buffer, record + wp.uint32(2)) -
            blob_device_number(buffer, record + wp.uint32(14)) + place.step[2])
    square = x * x + y * y + z * z
    node = blob_device_node()
    node.record = record
    node.x[0] = x
    node.x[1] = y
    node.x[2] = z
    node.rivals = wp.uint32(0)
    node.blocks = blob_device_load(buffer, node.record + wp.uint32(11))
    if node.blocks > wp.uint32(1) and square < blob_device_number(buffer, node.record +
            wp.uint32(7)):
        node.blocks = wp.uint32(1)
    node.neighbour = (v.words + v.neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS *
            blob_device_load(buffer, node.record + wp.uint32(10)))
    return node


@wp.func
def blob_device_locate(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        place: blob_device_place):
    best = wp.uint32(0)
    least = wp.float32(3e38)
    for index_1 in range(wp.int32(v.node_count)):
        i = wp.uint32(index_1)
        node = blob_device_at(buffer, v, i, place)
        r = blob_device_number(buffer, node.record + wp.uint32(3))
        power = node.x[0] * node.x[0] + node.x[1] * node.x[1] + node.x[2] * node.x[2] - r * r
        if power < least:
            least = power
            best = i
    return best


@wp.func
def blob_device_difference(buffer: wp.array(dtype=wp.uint32), block: wp.uint32, lane: wp.uint32,
        x: wp.vec3):
    k = block + lane
    return (blob_device_number(buffer, k) * x[0] + blob_device_number(buffer, k + wp.uint32(8)) *
            x[1] + blob_device_number(buffer, k + wp.uint32(16)) * x[2] +
            blob_device_number(buffer, k + wp.uint32(24)))


@wp.func
def blob_device_step(s: wp.float32):
    return (6.0 * s - 15.0) * s + 10.0


@wp.func
def blob_device_exponent(buffer: wp.array(dtype=wp.uint32), blob: wp.uint32, at: wp.vec3,
        d: wp.vec3):
    d[0] = at[0] - blob_device_number(buffer, blob)
    d[1] = at[1] - blob_device_number(buffer, blob + wp.uint32(8))
    d[2] = at[2] - blob_device_number(buffer, blob + wp.uint32(16))
    return blob_device_number(buffer, blob + wp.uint32(24)) * (d[0] * d[0] + d[1] * d[1] + d[2] *
            d[2]), d


@wp.func
def blob_device_term(phi: wp.uint32, u: wp.float32, a: wp.float32, w: wp.float32,
        slope: wp.float32):
    q = wp.float32(0.0)
    value = wp.float32(0.0)
    if phi == wp.uint32(0):
        q = 1.0 / (1.0 + u)
        value = w * (q * q)
        slope = -4.0 * a * (value * q)
        return value, slope
    if phi == wp.uint32(1):
        value = w * blob_device_exp(-u)
        slope = -2.0 * a * value
        return value, slope
    q = blob_device_greater(1.0 - u, 0.0)
    if phi == wp.uint32(2):
        slope = -4.0 * a * (w * q)
        return w * (q * q), slope
    slope = -2.0 / 9.0 * a * (w * q) * (10.0 + 12.0 * q)
    return w * (q * q) * (5.0 + 4.0 * q) * (1.0 / 9.0), slope


@wp.func
def blob_device_total(e: blob_device_eight):
    return (e.lanes[0] + e.lanes[2] + (e.lanes[1] + e.lanes[3]) +
            (e.lanes[4] + e.lanes[6] + (e.lanes[5] + e.lanes[7])))


@wp.func
def blob_device_first(bits: wp.uint32):
    found = wp.uint32(8)
    for index_1 in range(wp.int32(wp.uint32(8))):
        i = wp.uint32(index_1)
        if found == wp.uint32(8) and ((bits >> i) & wp.uint32(1)) != wp.uint32(0):
            found = i
    return found


@wp.func
def blob_device_count(bits: wp.uint32):
    count = wp.uint32(0)
    for index_1 in range(wp.int32(wp.uint32(8))):
        i = wp.uint32(index_1)
        count += (bits >> i) & wp.uint32(1)
    return count


@wp.func
def blob_device_below(buffer: wp.array(dtype=wp.uint32), block: wp.uint32, x: wp.vec3,
        limit: wp.float32):
    bits = wp.uint32(0)
    for index_1 in range(wp.int32(wp.uint32(8))):
        i = wp.uint32(index_1)
        if blob_device_difference(buffer, block, i, x) * blob_device_number(buffer, block +
                (i + wp.uint32(32))) < limit:
            bits = bits | (wp.uint32(1) << i)
    return bits


@wp.func
def blob_device_lower(buffer: wp.array(dtype=wp.uint32), block: wp.uint32, x: wp.vec3,
        node: wp.uint32, least: wp.float32, next: wp.uint32):
    bits = wp.uint32(0)
    for index_1 in range(wp.int32(wp.uint32(8))):
        i = wp.uint32(index_1)
        difference = blob_device_difference(buffer, block, i, x)
        k = blob_device_load(buffer, block + (i + wp.uint32(40)))
        if difference * blob_device_number(buffer, block + (i + wp.uint32(32))) < 1.0:
            bits = bits | (wp.uint32(1) << i)
        if difference < least or ((difference == least and next != node) and k < next):
            least = difference
            next = k
    return bits, least, next


@wp.func
def blob_device_holds(buffer: wp.array(dtype=wp.uint32), block: wp.uint32, k: wp.uint32):
    found = wp.int32(0)
    for index_1 in range(wp.int32(wp.uint32(8))):
        i = wp.uint32(index_1)
        if blob_device_load(buffer, block + (i + wp.uint32(40))) == k:
            found = wp.int32(1)
    return found


@wp.func
def blob_device_weigh_against(buffer: wp.array(dtype=wp.uint32), block: wp.uint32, x: wp.vec3,
        part: wp.vec3):
    psi = blob_device_eight()
    along_x = blob_device_eight()
    along_y = blob_device_eight()
    along_z = blob_device_eight()
    for index_1 in range(wp.int32(wp.uint32(8))):
        i = wp.uint32(index_1)
        inverse_tau = blob_device_number(buffer, block + (i + wp.uint32(32)))
        t = blob_device_difference(buffer, block, i, x) * inverse_tau
        s = blob_device_lesser(blob_device_greater(0.5 + 0.5 * t, 0.0), 1.0)
        sp = s * blob_device_step(s)
        rest = 1.0 - s
        q = 15.0 * (rest * rest) * inverse_tau / sp
        psi.lanes[i] = s * s * sp
        along_x.lanes[i] = q * blob_device_number(buffer, block + i)
        along_y.lanes[i] = q * blob_device_number(buffer, block + (i + wp.uint32(8)))
        along_z.lanes[i] = q * blob_device_number(buffer, block + (i + wp.uint32(16)))
    part[0] = blob_device_total(along_x)
    part[1] = blob_device_total(along_y)
    part[2] = blob_device_total(along_z)
    return psi.lanes[0] * psi.lanes[2] * (psi.lanes[1] * psi.lanes[3]) * (psi.lanes[4] *
            psi.lanes[6] * (psi.lanes[5] * psi.lanes[7])), part


@wp.func
def blob_device_least_exponent(buffer: wp.array(dtype=wp.uint32), first: wp.uint32,
        count: wp.uint32, at: wp.vec3):
    least = wp.float32(3e38)
    d = wp.vec3()
    for index_1 in range(wp.int32(count)):
        b = wp.uint32(index_1)
        for index_2 in range(wp.int32(wp.uint32(8))):
            i = wp.uint32(index_2)
            blob = first + BLOB_DEVICE_BLOB_WORDS * b + i
            result_3, d = blob_device_exponent(buffer, blob, at, d)
            u = result_3
            if blob_device_number(buffer, blob + wp.uint32(32)) > 0.0:
                least = blob_device_lesser(u, least)
    return least


@wp.func
def blob_device_sum_blobs(buffer: wp.array(dtype=wp.uint32), phi: wp.uint32, first: wp.uint32,
        count: wp.uint32, at: wp.vec3, shift: wp.float32, lane: blob_device_lane):
    f = blob_device_eight()
    along_x = blob_device_eight()
    along_y = blob_device_eight()
    along_z = blob_device_eight()
    for index_1 in range(wp.int32(wp.uint32(8))):
        i = wp.uint32(index_1)
        along_z.lanes[i] = wp.float32(0.0)
        along_y.lanes[i] = wp.float32(0.0)
        along_x.lanes[i] = wp.float32(0.0)
        f.lanes[i] = wp.float32(0.0)
    for index_2 in range(wp.int32(count)):
        b = wp.uint32(index_2)
        for index_3 in range(wp.int32(wp.uint32(8))):
            i = wp.uint32(index_3)
            blob = first + BLOB_DEVICE_BLOB_WORDS * b + i
            d = wp.vec3()
            slope = wp.float32(0.0)
            result_4, d = blob_device_exponent(buffer, blob, at, d)
            u = result_4
            u = wp.where(phi == wp.uint32(1), blob_device_greater(u - shift, 0.0), u)
            result_6, slope = blob_device_term(phi, u, blob_device_number(buffer, blob +
                    wp.uint32(24)), blob_device_number(buffer, blob + wp.uint32(32)), slope)
            f.lanes[i] += result_6
            along_x.lanes[i] += slope * d[0]
            along_y.lanes[i] += slope * d[1]
            along_z.lanes[i] += slope * d[2]
    lane.field[0] = blob_device_total(f)
    lane.field[1] = blob_device_total(along_x)
    lane.field[2] = blob_device_total(along_y)
    lane.field[3] = blob_device_total(along_z)
    return lane


@wp.func
def blob_device_evaluate(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        node: blob_device_node):
    count = blob_device_load(buffer, node.record + wp.uint32(9))
    first = (v.words + v.blobs + BLOB_DEVICE_BLOB_WORDS *
            blob_device_load(buffer, node.record + wp.uint32(8)))
    lane = blob_device_lane()
    at = wp.vec3()
    at[0] = node.x[0] + blob_device_number(buffer, node.record + wp.uint32(4))
    at[1] = node.x[1] + blob_device_number(buffer, node.record + wp.uint32(5))
    at[2] = node.x[2] + blob_device_number(buffer, node.record + wp.uint32(6))
    lane.shift = wp.float32(0.0)
    if v.phi == wp.uint32(1) and count > wp.uint32(0):
        lane.shift = blob_device_least_exponent(buffer, first, count, at)
    lane.radius = blob_device_number(buffer, node.record + wp.uint32(3))
    lane = blob_device_sum_blobs(buffer, v.phi, first, count, at, lane.shift, lane)
    return lane


@wp.func
def blob_device_rivals(buffer: wp.array(dtype=wp.uint32), node: blob_device_node):
    for index_1 in range(wp.int32(node.blocks)):
        b = wp.uint32(index_1)
        if blob_device_below(buffer, node.neighbour + BLOB_DEVICE_NEIGHBOUR_WORDS * b, node.x,
                1.0) != wp.uint32(0):
            return BLOB_DEVICE_MANY
    return blob_device_below(buffer, node.neighbour, node.x, 1.0)


@wp.func
def blob_device_follow(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        place: blob_device_place, node: wp.uint32):
    here = blob_device_at(buffer, v, node, place)
    before = node
    for step in range(256):
        next = node
        least = wp.float32(0.0)
        here.rivals = wp.uint32(0)
        b = wp.uint32(0)
        while b < here.blocks:
            result_2, least, next = blob_device_lower(buffer, here.neighbour +
                    BLOB_DEVICE_NEIGHBOUR_WORDS * b, here.x, node, least, next)
            bits = result_2
            here.rivals = wp.where(b == wp.uint32(0), bits,
                    wp.where(bits != wp.uint32(0), BLOB_DEVICE_MANY, here.rivals))
            b += wp.uint32(1)
        if next == node or next == before:
            return here, node
        before = node
        node = next
        here = blob_device_at(buffer, v, next, place)
    here.rivals = blob_device_rivals(buffer, here)
    return here, node


@wp.func
def blob_device_add_active(blending: blob_device_active, k: wp.uint32):
    for i in range(blending.count):
        if blending.nodes[i] == k:
            return blending
    if blending.count < BLOB_DEVICE_MOST_ACTIVE:
        blending.nodes[blending.count] = k
        blending.count += 1
    return blending


@wp.func
def blob_device_is_neighbour(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        node: wp.uint32, k: wp.uint32):
    record = v.words + v.nodes + BLOB_DEVICE_NODE_WORDS * node
    first = (v.words + v.neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS *
            blob_device_load(buffer, record + wp.uint32(10)))
    for index_1 in range(wp.int32(blob_device_load(buffer, record + wp.uint32(11)))):
        b = wp.uint32(index_1)
        if blob_device_holds(buffer, first + BLOB_DEVICE_NEIGHBOUR_WORDS * b, k) != 0:
            return wp.int32(1)
    return wp.int32(0)


@wp.func
def blob_device_weigh(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel, index: wp.uint32,
        node: blob_device_node, blending: blob_device_active, gradient: wp.vec3):
    number = wp.uint32(0)
    u = wp.float32(1.0)
    part = wp.vec3()
    for axis in range(3):
        gradient[axis] = wp.float32(0.0)
    for index_1 in range(wp.int32(node.blocks)):
        b = wp.uint32(index_1)
        block = node.neighbour + BLOB_DEVICE_NEIGHBOUR_WORDS * b
        rivals = blob_device_below(buffer, block, node.x, 1.0)
        if rivals == wp.uint32(0):
            continue
        result_3, part = blob_device_weigh_against(buffer, block, node.x, part)
        u *= result_3
        if not (u > 1e-20):
            return wp.float32(0.0), blending, gradient
        for axis in range(3):
            gradient[axis] += part[axis]
        number = blob_device_count(rivals)
        for index_5 in range(wp.int32(number)):
            i = wp.uint32(index_5)
            k = blob_device_load(buffer, block + (blob_device_first(rivals) + wp.uint32(40)))
            rivals = rivals & (rivals - wp.uint32(1))
            if index == blending.nodes[0] or blob_device_is_neighbour(buffer, v, blending.nodes[0],
                    k) == 0:
                blending = blob_device_add_active(blending, k)
    for axis in range(3):
        gradient[axis] *= u
    return u, blending, gradient


@wp.func
def blob_device_share_shift(first: wp.float32, second: wp.float32, of_first: wp.float32,
        of_second: wp.float32):
    difference = first - second
    of_first = wp.float32(1.0)
    of_second = wp.float32(1.0)
    if difference <= 60.0:
        of_second = blob_device_exp(difference)
    else:
        first = second
        of_first = blob_device_exp(-difference)
    return first, of_first, of_second


@wp.func
def blob_device_add(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel, own: blob_device_lane,
        u: wp.float32, gradient: wp.vec3, sum: blob_device_mixture):
    of_sum = wp.float32(1.0)
    of_own = wp.float32(1.0)
    above = wp.float32(0.0)
    if sum.is_empty != 0:
        sum.is_empty = wp.int32(0)
        sum.f0 = own.field[0]
        sum.shift = own.shift
    elif v.phi == wp.uint32(1):
        copy_1, of_sum, of_own = blob_device_share_shift(sum.shift, own.shift, of_sum, of_own)
        sum.shift = copy_1
        sum.f0 *= of_sum
        for i in range(4):
            sum.excess[i] *= of_sum
            sum.field[i] *= of_sum
    above = of_own * own.field[0] - sum.f0
    sum.weight[0] += u
    sum.excess[0] += above * u
    sum.field[0] += u * (of_own * own.field[0])
    for i in range(3):
        sum.weight[i + 1] += gradient[i]
        sum.excess[i + 1] += above * gradient[i]
        sum.field[i + 1] += u * (of_own * own.field[i + 1])
    sum.radius += u * own.radius
    return sum


@wp.func
def blob_device_clear(sum: blob_device_mixture):
    for i in range(4):
        sum.field[i] = wp.float32(0.0)
        sum.excess[i] = wp.float32(0.0)
        sum.weight[i] = wp.float32(0.0)
    sum.shift = wp.float32(0.0)
    sum.f0 = wp.float32(0.0)
    sum.radius = wp.float32(0.0)
    sum.is_empty = wp.int32(1)
    return sum


@wp.func
def blob_device_quotient(sum: blob_device_mixture):
    inverse = 1.0 / sum.weight[0]
    excess = sum.excess[0] * inverse
    lane = blob_device_lane()
    lane.field[0] = sum.f0 + excess
    for i in range(1, 4):
        lane.field[i] = (sum.field[i] + (sum.excess[i] - excess * sum.weight[i])) * inverse
    lane.shift = sum.shift
    lane.radius = sum.radius * inverse
    return lane


@wp.func
def blob_device_blend_all(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        place: blob_device_place, start: wp.uint32, lane: blob_device_lane):
    blending = blob_device_active()
    sum = blob_device_mixture()
    gradient = wp.vec3()
    sum = blob_device_clear(sum)
    blending.nodes[0] = start
    blending.count = wp.int32(1)
    n = wp.int32(0)
    while n < blending.count:
        before = blending.count
        node = blob_device_at(buffer, v, blending.nodes[n], place)
        result_2, blending, gradient = blob_device_weigh(buffer, v, blending.nodes[n], node,
                blending, gradient)
        u = result_2
        if u > 0.0:
            own = blob_device_lane()
            if n == 0:
                own = lane
            else:
                own = blob_device_evaluate(buffer, v, node)
            sum = blob_device_add(buffer, v, own, u, gradient, sum)
        else:
            blending.count = before
        n += 1
    if sum.is_empty == 0:
        lane = blob_device_quotient(sum)
    return lane


@wp.func
def blob_device_pair(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel, node: wp.uint32,
        other: blob_device_node, rivals: wp.uint32, t: wp.float32):
    number = wp.uint32(0)
    rest = rivals
    if rivals == BLOB_DEVICE_MANY or not (t > -0.999):
        return wp.int32(0)
    if (rivals & (rivals - wp.uint32(1))) == wp.uint32(0):
        if rivals == wp.uint32(0) or blob_device_load(buffer, other.neighbour +
                (blob_device_first(rivals) + wp.uint32(40))) == node:
            return wp.int32(1)
    number = blob_device_count(rivals)
    for index_3 in range(wp.int32(number)):
        i = wp.uint32(index_3)
        k = blob_device_load(buffer, other.neighbour + (blob_device_first(rest) + wp.uint32(40)))
        rest = rest & (rest - wp.uint32(1))
        if k != node and blob_device_is_neighbour(buffer, v, node, k) == 0:
            return wp.int32(0)
    return wp.int32(2)


@wp.func
def blob_device_mix(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel, rival: wp.uint32,
        t: wp.float32, other: blob_device_lane, lane: blob_device_lane):
    s = 0.5 + 0.5 * t
    rest = 1.0 - s
    psi = s * s * s * blob_device_step(s)
    slope = 15.0 * (s * s * (rest * rest)) * blob_device_number(buffer, rival + wp.uint32(32))
    of_own = wp.float32(1.0)
    of_other = wp.float32(1.0)
    excess = wp.vec4()
    if v.phi == wp.uint32(1):
        copy_2, of_own, of_other = blob_device_share_shift(lane.shift, other.shift, of_own,
                of_other)
        lane.shift = copy_2
    for i in range(4):
        excess[i] = lane.field[i] * of_own - other.field[i] * of_other
    if v.phi == wp.uint32(1):
        other_psi = rest * rest * rest * blob_device_step(rest)
        for i in range(4):
            lane.field[i] = psi * (lane.field[i] * of_own) + other_psi * (other.field[i] * of_other)
    else:
        for i in range(4):
            lane.field[i] = other.field[i] * of_other + psi * excess[i]
    for i in range(3):
        lane.field[i + 1] += (slope * excess[0] * blob_device_number(buffer, rival +
                wp.uint32(8 * i)))
    lane.radius = other.radius + psi * (lane.radius - other.radius)
    return lane


@wp.func
def blob_device_mix_two(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel, rival: wp.uint32,
        t: wp.float32, node: blob_device_node, other: blob_device_lane, lane: blob_device_lane):
    s = 0.5 + 0.5 * t
    rest = 1.0 - s
    sp = s * blob_device_step(s)
    u = s * s * sp
    q = 15.0 * (rest * rest) * blob_device_number(buffer, rival + wp.uint32(32)) / sp
    own = lane
    sum = blob_device_mixture()
    gradient = wp.vec3()
    product = wp.float32(0.0)
    sum = blob_device_clear(sum)
    for i in range(3):
        gradient[i] = u * (q * blob_device_number(buffer, rival + wp.uint32(8 * i)))
    sum = blob_device_add(buffer, v, own, u, gradient, sum)
    result_2, gradient = blob_device_weigh_against(buffer, node.neighbour, node.x, gradient)
    product = result_2
    if product > 1e-20:
        for i in range(3):
            gradient[i] *= product
        sum = blob_device_add(buffer, v, other, product, gradient, sum)
    lane = blob_device_quotient(sum)
    return lane


@wp.func
def blob_device_blend_one(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        place: blob_device_place, index: wp.uint32, node: blob_device_node, number: wp.uint32,
        lane: blob_device_lane):
    rival = node.neighbour + number
    t = (blob_device_difference(buffer, rival, wp.uint32(0), node.x) *
            blob_device_number(buffer, rival + wp.uint32(32)))
    other = blob_device_at(buffer, v, blob_device_load(buffer, rival + wp.uint32(40)), place)
    kind = blob_device_pair(buffer, v, index, other, blob_device_rivals(buffer, other), t)
    second = blob_device_lane()
    if kind == 0:
        return wp.int32(0), lane
    second = blob_device_evaluate(buffer, v, other)
    if kind == 1:
        lane = blob_device_mix(buffer, v, rival, t, second, lane)
    else:
        lane = blob_device_mix_two(buffer, v, rival, t, other, second, lane)
    return wp.int32(1), lane


@wp.func
def blob_device_blend(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        place: blob_device_place, index: wp.uint32, node: blob_device_node, lane: blob_device_lane):
    rivals = node.rivals
    if rivals == wp.uint32(0):
        return lane
    result_2, lane = blob_device_blend_one(buffer, v, place, index, node, blob_device_first(rivals),
            lane)
    if (rivals & (rivals - wp.uint32(1))) != wp.uint32(0) or result_2 == 0:
        lane = blob_device_blend_all(buffer, v, place, index, lane)
    return lane


@wp.func
def blob_device_level(phi: wp.uint32, f: wp.float32, shift: wp.float32, relative: wp.float32,
        slope: wp.float32):
    h = wp.float32(0.0)
    if phi == wp.uint32(1):
        slope = relative
        return shift - blob_device_log(f), slope
    h = wp.where(phi == wp.uint32(0), wp.sqrt(1.0 / f), 0.0 - wp.sqrt(f))
    slope = wp.where(phi == wp.uint32(0), 0.5, -0.5) * h * relative
    return h, slope


@wp.func
def blob_device_wall(difference: wp.float32, slope: wp.float32, radius: wp.float32,
        inside: wp.int32):
    d = wp.where(difference < 0.0, -difference, difference)
    gr = slope * radius
    s = wp.sqrt(d * d + gr * gr)
    t = gr + s
    if not (d > 0.0):
        return wp.float32(0.0)
    return (d * (t + d) * wp.where(inside != 0, -radius, 1.0) /
            (t * wp.where(inside != 0, d + s, slope)))


@wp.func
def blob_device_finish(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        lane: blob_device_lane, at: wp.vec3, sample: blob_device_sample):
    f = lane.field[0]
    inverse_f = 1.0 / f
    to_centre = blob_device_norm(at)
    scale = wp.where(v.phi != wp.uint32(1), 1.0, wp.where(lane.shift > 87.0, 0.0,
            blob_device_exp(-lane.shift)))
    e = wp.vec3()
    length = wp.float32(0.0)
    h = wp.float32(0.0)
    slope = wp.float32(0.0)
    inside = wp.int32(0)
    sample.value = f * scale
    for i in range(3):
        e[i] = lane.field[1 + i] * inverse_f
        sample.gradient[i] = lane.field[1 + i] * scale
    inside = wp.where(sample.value > v.level, 1, 0)
    length = blob_device_norm(e)
    result_4, slope = blob_device_level(v.phi, f, lane.shift, length, slope)
    h = result_4
    sample.distance = blob_device_wall(v.transformed_level - h, slope, lane.radius, inside)
    if inside == 0:
        sample.distance = blob_device_lesser(sample.distance, to_centre + lane.radius)
        if not (f > 1e-20):
            sample.distance = blob_device_greater(to_centre - lane.radius, 0.0)
            for i in range(3):
                e[i] = -at[i]
            length = to_centre
    for i in range(3):
        sample.normal[i] = wp.where(length > 0.0, e[i] * (-1.0 / length), 0.0)
    sample.state = wp.where(inside != 0, BLOB_DEVICE_INSIDE, wp.uint32(0))
    return sample


@wp.func
def blob_device_is_out_of_range(buffer: wp.array(dtype=wp.uint32), node: blob_device_node,
        sample: blob_device_sample):
    most = wp.float32(1e9)
    length = wp.float32(0.0)
    if ((((node.x[0] <= most and node.x[0] >= -most) and node.x[1] <= most) and node.x[1] >= -most)
            and node.x[2] <= most) and node.x[2] >= -most:
        return wp.int32(0), sample
    length = blob_device_norm(node.x)
    sample.value = wp.where(length - length == 0.0, 0.0, wp.where(length > 0.0, 0.0, length))
    sample.distance = length - blob_device_number(buffer, node.record + wp.uint32(3))
    for i in range(3):
        sample.gradient[i] = sample.value
        sample.normal[i] = wp.where(length > 0.0 and length <= 3e38, node.x[i] / length,
                sample.value)
    sample.state = wp.uint32(0)
    return wp.int32(1), sample


@wp.func
def blob_device_enter(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel, flags: wp.uint32,
        place: blob_device_place, cursor: wp.uint32, node: blob_device_node,
        sample: blob_device_sample):
    node = blob_device_at(buffer, v, cursor, place)
    result_2, sample = blob_device_is_out_of_range(buffer, node, sample)
    if result_2 != 0:
        sample.node = cursor
        return wp.int32(0), cursor, node, sample
    if (flags & BLOB_DEVICE_HOLD) == wp.uint32(0):
        result_3, cursor = blob_device_follow(buffer, v, place, cursor)
        node = result_3
    else:
        node.rivals = blob_device_rivals(buffer, node)
    return wp.int32(1), cursor, node, sample


@wp.func
def blob_device_sample_at(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        flags: wp.uint32, place: blob_device_place, cursor: wp.uint32, sample: blob_device_sample):
    node = blob_device_node()
    lane = blob_device_lane()
    result_1, cursor, node, sample = blob_device_enter(buffer, v, flags, place, cursor, node,
            sample)
    if result_1 == 0:
        return wp.int32(0), cursor, sample
    lane = blob_device_evaluate(buffer, v, node)
    if (flags & BLOB_DEVICE_LOCAL) == wp.uint32(0):
        lane = blob_device_blend(buffer, v, place, cursor, node, lane)
    sample = blob_device_finish(buffer, v, lane, node.x, sample)
    sample.node = cursor
    return wp.int32(1), cursor, sample


@wp.func
def blob_device_query(buffer: wp.array(dtype=wp.uint32), words: wp.uint32, vessel: wp.uint32,
        flags: wp.uint32, point: wp.vec3, cursor: wp.uint32, sample: blob_device_sample):
    v = blob_device_open(buffer, words, vessel)
    place = blob_device_place_at(point)
    if cursor >= v.node_count:
        cursor = blob_device_locate(buffer, v, place)
    result_4, cursor, sample = blob_device_sample_at(buffer, v, flags, place, cursor, sample)
    result_4
    return cursor, sample


@wp.func
def blob_device_dot(a: wp.vec3, b: wp.vec3):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@wp.func
def blob_device_size(x: wp.float32):
    return wp.where(x < 0.0, -x, x)


@wp.func
def blob_device_cross(a: wp.vec3, b: wp.vec3, result: wp.vec3):
    result[0] = a[1] * b[2] - a[2] * b[1]
    result[1] = a[2] * b[0] - a[0] * b[2]
    result[2] = a[0] * b[1] - a[1] * b[0]
    return result


@wp.func
def blob_device_along(a: wp.vec3, s: wp.float32, b: wp.vec3, result: wp.vec3):
    for i in range(3):
        result[i] = a[i] + s * b[i]
    return result


@wp.func
def blob_device_perpendicular(a: wp.vec3, result: wp.vec3):
    x = blob_device_size(a[0])
    y = blob_device_size(a[1])
    z = blob_device_size(a[2])
    axis = wp.vec3()
    inverse = wp.float32(0.0)
    for i in range(3):
        axis[i] = wp.float32(0.0)
    if x <= y and x <= z:
        axis[0] = wp.float32(1.0)
    elif y <= z:
        axis[1] = wp.float32(1.0)
    else:
        axis[2] = wp.float32(1.0)
    result = blob_device_cross(a, axis, result)
    inverse = 1.0 / blob_device_norm(result)
    for i in range(3):
        result[i] = result[i] * inverse
    return result


@wp.func
def blob_device_turn(s: blob_device_search, a: wp.vec3, result: wp.vec3):
    result[0] = s.diagonal[0] * a[0] + s.mixed[0] * a[1] + s.mixed[1] * a[2]
    result[1] = s.mixed[0] * a[0] + s.diagonal[1] * a[1] + s.mixed[2] * a[2]
    result[2] = s.mixed[1] * a[0] + s.mixed[2] * a[1] + s.diagonal[2] * a[2]
    return result


@wp.func
def blob_device_add_products(s: blob_device_search, r: wp.vec3, m: wp.vec3):
    for i in range(3):
        s.diagonal[i] += 2.0 * (r[i] * m[i])
    s.mixed[0] += r[0] * m[1] + m[0] * r[1]
    s.mixed[1] += r[0] * m[2] + m[0] * r[2]
    s.mixed[2] += r[1] * m[2] + m[1] * r[2]
    return s


@wp.func
def blob_device_shape(s: blob_device_search, inverse_step: wp.float32):
    along_first = wp.vec3()
    along_second = wp.vec3()
    r = wp.vec3()
    for i in range(3):
        along_first[i] = (s.turned[i] - s.best.normal[i]) * inverse_step
        along_second[i] = (s.here.normal[i] - s.best.normal[i]) * inverse_step
        s.mixed[i] = wp.float32(0.0)
        s.diagonal[i] = wp.float32(0.0)
    for i in range(3):
        r[i] = (0.5 * blob_device_dot(along_first, s.first) * s.first[i] + 0.5 *
                (blob_device_dot(along_first, s.second) + blob_device_dot(along_second, s.first)) *
                s.second[i])
    s = blob_device_add_products(s, r, s.first)
    for i in range(3):
        r[i] = 0.5 * blob_device_dot(along_second, s.second) * s.second[i]
    s = blob_device_add_products(s, r, s.second)
    return s


@wp.func
def blob_device_bend(s: blob_device_search, moved: wp.vec3, turn: wp.vec3):
    square = blob_device_dot(moved, moved)
    missing = wp.vec3()
    r = wp.vec3()
    inverse = wp.float32(0.0)
    part = wp.float32(0.0)
    if not (square > 0.0):
        return s
    inverse = 1.0 / square
    missing = blob_device_turn(s, moved, missing)
    for i in range(3):
        missing[i] = turn[i] - missing[i]
    part = 0.5 * inverse * blob_device_dot(missing, moved)
    for i in range(3):
        r[i] = inverse * (missing[i] - part * moved[i])
    s = blob_device_add_products(s, r, moved)
    return s


@wp.func
def blob_device_part(s: blob_device_search, part: wp.float32, eigenvalue: wp.float32):
    flat = wp.float32(0.02)
    leave = wp.float32(0.1)
    if eigenvalue < -flat and blob_device_size(part) < s.tolerance:
        return leave * s.radius
    return part / blob_device_greater(blob_device_size(eigenvalue), flat)


@wp.func
def blob_device_find_step(s: blob_device_search):
    valley = wp.float32(0.2)
    doubted = wp.float32(0.2)
    longest = 0.5 * s.radius
    of_first = wp.vec3()
    of_second = wp.vec3()
    a = wp.float32(0.0)
    b = wp.float32(0.0)
    c = wp.float32(0.0)
    t1 = wp.float32(0.0)
    t2 = wp.float32(0.0)
    x = wp.float32(0.0)
    y = wp.float32(0.0)
    distance = wp.float32(0.0)
    share = wp.float32(0.0)
    copy_1 = blob_device_perpendicular(s.best.normal, s.first)
    s.first = copy_1
    copy_2 = blob_device_cross(s.best.normal, s.first, s.second)
    s.second = copy_2
    of_first = blob_device_turn(s, s.first, of_first)
    of_second = blob_device_turn(s, s.second, of_second)
    distance = s.best.distance - blob_device_dot(s.best.at, s.best.normal)
    a = 1.0 + distance * blob_device_dot(s.first, of_first)
    b = distance * blob_device_dot(s.first, of_second)
    c = 1.0 + distance * blob_device_dot(s.second, of_second)
    t1 = -blob_device_dot(s.first, s.best.at)
    t2 = -blob_device_dot(s.second, s.best.at)
    if a > valley and (a - valley) * (c - valley) > b * b:
        inverse = 1.0 / (a * c - b * b)
        x = inverse * (c * t1 - b * t2)
        y = inverse * (a * t2 - b * t1)
    else:
        mean = 0.5 * (a + c)
        spread = 0.5 * (a - c)
        root = wp.sqrt(spread * spread + b * b)
        turn = wp.where(root > 0.0, spread / root, 1.0)
        cosine = wp.sqrt(blob_device_greater(0.5 * (1.0 + turn), 0.0))
        positive = wp.sqrt(blob_device_greater(0.5 * (1.0 - turn), 0.0))
        sine = wp.where(b < 0.0, -positive, positive)
        p1 = blob_device_part(s, cosine * t1 + sine * t2, mean + root)
        p2 = blob_device_part(s, cosine * t2 - sine * t1, mean - root)
        x = cosine * p1 - sine * p2
        y = sine * p1 + cosine * p2
    s.length = wp.sqrt(x * x + y * y)
    share = wp.where(s.length > longest, longest / s.length, 1.0)
    x = x * share
    y = y * share
    s.length = s.length * share
    for i in range(3):
        s.step[i] = x * s.first[i] + y * s.second[i]
    of_first = blob_device_turn(s, s.step, of_first)
    s.sag = 0.5 * blob_device_dot(s.step, of_first)
    s.gain = 0.5 * (x * t1 + y * t2)
    if s.is_improving == 0:
        s.gain = blob_device_greater(s.gain, 0.5 / doubted * (t1 * t1 + t2 * t2))
    return s


@wp.func
def blob_device_wait(s: blob_device_search, stage: wp.uint32, share: wp.float32, vector: wp.vec3):
    copy_1 = blob_device_along(s.best.at, share, vector, s.here.at)
    s.here.at = copy_1
    s.here.node = s.best.node
    s.stage = stage
    return s


@wp.func
def blob_device_axis(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel, node: wp.uint32,
        axis: wp.vec3):
    record = v.words + v.nodes + BLOB_DEVICE_NODE_WORDS * node
    first = (v.words + v.neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS *
            blob_device_load(buffer, record + wp.uint32(10)))
    length = wp.float32(0.0)
    for i in range(3):
        axis[i] = blob_device_number(buffer, first + wp.uint32(8 * i))
    length = blob_device_norm(axis)
    for i in range(3):
        axis[i] = wp.where(length > 0.0, axis[i] / length, wp.where(i == 0, 1.0, 0.0))
    return axis


@wp.func
def blob_device_go_beside(s: blob_device_search):
    across = 0.7 * s.radius
    signed_length = wp.where((s.tried & 1) == 0, across, -across)
    for i in range(3):
        s.here.at[i] = signed_length * wp.where(s.tried < 2, s.first[i], s.second[i])
    s.stage = BLOB_DEVICE_BESIDE
    return s


@wp.func
def blob_device_reach(s: blob_device_search):
    return 0.002 * s.radius


@wp.func
def blob_device_curve(s: blob_device_search):
    reach = blob_device_reach(s)
    copy_2 = blob_device_perpendicular(s.best.normal, s.first)
    s.first = copy_2
    copy_3 = blob_device_cross(s.best.normal, s.first, s.second)
    s.second = copy_3
    s.tried = wp.int32(0)
    s = blob_device_wait(s, BLOB_DEVICE_CURVING, reach, s.first)
    return s


@wp.func
def blob_device_go_on(s: blob_device_search):
    depth = s.best.distance + s.share * s.share * s.sag
    s = blob_device_wait(s, BLOB_DEVICE_GLIDING, s.share, s.step)
    copy_1 = blob_device_along(s.here.at, -depth, s.best.normal, s.here.at)
    s.here.at = copy_1
    return s


@wp.func
def blob_device_project(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        s: blob_device_search):
    is_near = wp.where(blob_device_size(s.here.distance) <= 0.5 * s.tolerance, 1, 0)
    axis = wp.vec3()
    if not (s.here.value > 1e-20) and not (blob_device_size(s.here.distance) > 0.0):
        s.stage = BLOB_DEVICE_STOPPED
        return wp.int32(0), s
    if not (blob_device_dot(s.here.normal, s.here.normal) > 0.0):
        axis = blob_device_axis(buffer, v, s.here.node, axis)
        copy_4 = blob_device_perpendicular(axis, s.here.normal)
        s.here.normal = copy_4
    copy_5 = blob_device_along(s.here.at, -s.here.distance, s.here.normal, s.here.at)
    s.here.at = copy_5
    s.here.distance = wp.float32(0.0)
    s.stage = BLOB_DEVICE_PROJECTING
    return is_near, s


@wp.func
def blob_device_improve(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        s: blob_device_search):
    most_halvings = wp.int32(8)
    stalled = wp.float32(1e-3)
    length = wp.float32(0.0)
    result_1, s = blob_device_project(buffer, v, s)
    if result_1 == 0:
        return s
    length = blob_device_norm(s.here.at)
    if s.is_improving == 0 or length < s.nearest:
        s.is_improving = wp.int32(1)
        s.nearest = length
        s.best = s.here
        s = blob_device_curve(s)
        return s
    s.places += 1
    s.share = 0.5 * s.share
    if s.places < most_halvings:
        s = blob_device_wait(s, BLOB_DEVICE_PROJECTING, s.share, s.step)
    else:
        s.stage = wp.where(s.gain <= stalled * (s.nearest * s.nearest), BLOB_DEVICE_FOUND,
                BLOB_DEVICE_STOPPED)
    return s


@wp.func
def blob_device_stop_gliding(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        s: blob_device_search):
    s.here = s.best
    s.is_improving = wp.int32(0)
    s = blob_device_improve(buffer, v, s)
    return s


@wp.func
def blob_device_make_step(s: blob_device_search):
    enough = 0.1 * s.tolerance
    slow = wp.float32(0.6)
    misjudged = wp.float32(0.3)
    before = wp.where(s.steps == 0 or s.share < 1.0, 0.0, s.length)
    off = s.best.distance
    length = wp.float32(0.0)
    s = blob_device_find_step(s)
    s.share = wp.float32(1.0)
    if s.is_improving != 0:
        s.places = wp.int32(0)
        if s.length <= s.tolerance or s.gain <= enough * s.nearest:
            s.stage = BLOB_DEVICE_FOUND
        else:
            s = blob_device_wait(s, BLOB_DEVICE_PROJECTING, 1.0, s.step)
        return s
    copy_1 = blob_device_along(s.best.at, -off, s.best.normal, s.begun)
    s.begun = copy_1
    for i in range(3):
        s.before[i] = s.best.normal[i]
    length = blob_device_norm(s.begun)
    s.reached = length + misjudged * off * off / s.radius
    s.steps += 1
    if before > 0.0 and s.length > slow * before:
        s.slow += 1
    if off * off <= enough * s.radius and s.gain <= enough * length:
        s.stage = BLOB_DEVICE_FOUND
    else:
        s = blob_device_go_on(s)
    return s


@wp.func
def blob_device_glide(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        s: blob_device_search):
    most_places = wp.int32(12)
    most_slow = wp.int32(1)
    shorten = wp.float32(0.4)
    least_share = wp.float32(0.1)
    off_wall = 0.1 * s.radius
    foot = wp.vec3()
    turn = wp.vec3()
    foot = blob_device_along(s.here.at, -s.here.distance, s.here.normal, foot)
    if s.places == 0:
        s.best = s.here
    s.places += 1
    if s.places > most_places or not (s.here.value > 1e-20):
        s = blob_device_stop_gliding(buffer, v, s)
        return s
    if s.steps > 0 and blob_device_norm(foot) > s.reached:
        s.share = shorten * s.share
        if s.share < least_share:
            s = blob_device_stop_gliding(buffer, v, s)
        else:
            s = blob_device_go_on(s)
        return s
    s.best = s.here
    if blob_device_size(s.here.distance) > off_wall:
        s = blob_device_wait(s, BLOB_DEVICE_GLIDING, -s.here.distance, s.here.normal)
    elif s.steps == 0 or s.slow > most_slow:
        s = blob_device_curve(s)
    else:
        foot = blob_device_along(foot, -1.0, s.begun, foot)
        turn = blob_device_along(s.best.normal, -1.0, s.before, turn)
        s = blob_device_bend(s, foot, turn)
        s = blob_device_make_step(s)
    return s


@wp.func
def blob_device_leave_point(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        s: blob_device_search):
    s.first_distance = s.here.distance
    s.best = s.here
    if s.here.value > 1e-20:
        s = blob_device_wait(s, BLOB_DEVICE_APPROACHING, -s.here.distance, s.here.normal)
    else:
        s = blob_device_improve(buffer, v, s)
    return s


@wp.func
def blob_device_arrive(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        s: blob_device_search):
    is_deep = wp.where(s.is_inside != 0 and s.first_distance < -0.5 * s.radius, 1, 0)
    axis = wp.vec3()
    if is_deep != 0 and s.here.distance < 0.5 * s.first_distance:
        axis = blob_device_axis(buffer, v, s.best.node, axis)
        copy_1 = blob_device_perpendicular(axis, s.first)
        s.first = copy_1
        copy_2 = blob_device_cross(axis, s.first, s.second)
        s.second = copy_2
        s.here.node = s.best.node
        s = blob_device_go_beside(s)
    else:
        s = blob_device_glide(buffer, v, s)
    return s


@wp.func
def blob_device_choose_side(s: blob_device_search):
    if s.tried == 0 or s.here.distance > s.best.distance:
        s.best = s.here
    s.tried += 1
    s.here.node = s.best.node
    if s.tried < 4:
        s = blob_device_go_beside(s)
    else:
        s = blob_device_wait(s, BLOB_DEVICE_GLIDING, -s.best.distance, s.best.normal)
    return s


@wp.func
def blob_device_see_shape(s: blob_device_search):
    reach = blob_device_reach(s)
    s.tried += 1
    if s.tried == 1:
        for i in range(3):
            s.turned[i] = s.here.normal[i]
        s = blob_device_wait(s, BLOB_DEVICE_CURVING, reach, s.second)
    else:
        s = blob_device_shape(s, 1.0 / reach)
        s = blob_device_make_step(s)
    return s


@wp.func
def blob_device_advance(buffer: wp.array(dtype=wp.uint32), v: blob_device_vessel,
        s: blob_device_search, there: blob_device_sample):
    s.here.value = there.value
    s.here.distance = there.distance
    s.here.node = there.node
    for i in range(3):
        s.here.normal[i] = there.normal[i]
    if s.stage == BLOB_DEVICE_AT_POINT:
        s = blob_device_leave_point(buffer, v, s)
    elif s.stage == BLOB_DEVICE_APPROACHING:
        s = blob_device_arrive(buffer, v, s)
    elif s.stage == BLOB_DEVICE_BESIDE:
        s = blob_device_choose_side(s)
    elif s.stage == BLOB_DEVICE_GLIDING:
        s = blob_device_glide(buffer, v, s)
    elif s.stage == BLOB_DEVICE_CURVING:
        s = blob_device_see_shape(s)
    else:
        s = blob_device_improve(buffer, v, s)
    return s


@wp.func
def blob_device_begin_search(s: blob_device_search, node: wp.uint32):
    for i in range(3):
        s.here.at[i] = wp.float32(0.0)
    s.here.node = node
    s.stage = BLOB_DEVICE_AT_POINT
    s.share = wp.float32(1.0)
    s.nearest = wp.float32(0.0)
    s.reached = wp.float32(0.0)
    s.gain = wp.float32(0.0)
    s.sag = wp.float32(0.0)
    s.length = wp.float32(0.0)
    s.slow = wp.int32(0)
    s.steps = wp.int32(0)
    s.places = wp.int32(0)
    s.tried = wp.int32(0)
    s.is_improving = wp.int32(0)
    return s


@wp.func
def blob_device_report(s: blob_device_search, sample: blob_device_sample):
    foot = wp.vec3()
    length = wp.float32(0.0)
    foot = blob_device_along(s.best.at, -s.best.distance, s.best.normal, foot)
    length = blob_device_norm(foot)
    sample.distance = wp.where(s.is_inside != 0, -length, length)
    for i in range(3):
        sample.normal[i] = s.best.normal[i]
    if s.stage != BLOB_DEVICE_FOUND:
        sample.state = sample.state | BLOB_DEVICE_NOT_CONVERGED
    return sample


@wp.func
def blob_device_query_exact(buffer: wp.array(dtype=wp.uint32), words: wp.uint32, vessel: wp.uint32,
        flags: wp.uint32, point: wp.vec3, cursor: wp.uint32, sample: blob_device_sample):
    v = blob_device_open(buffer, words, vessel)
    most = wp.int32(128)
    place = blob_device_place_at(point)
    s = blob_device_search()
    if cursor >= v.node_count:
        cursor = blob_device_locate(buffer, v, place)
    s = blob_device_begin_search(s, cursor)
    for n in range(most):
        there = blob_device_sample()
        node = s.here.node
        in_range = wp.int32(0)
        for i in range(3):
            place.step[i] = s.here.at[i]
        result_4, node, there = blob_device_sample_at(buffer, v, flags, place, node, there)
        in_range = result_4
        if n == 0:
            sample = there
            cursor = node
            if in_range == 0:
                return cursor, sample
            s.is_inside = wp.where((there.state & BLOB_DEVICE_INSIDE) != wp.uint32(0), 1, 0)
            s.radius = blob_device_number(buffer, v.words +
                    (v.nodes + BLOB_DEVICE_NODE_WORDS * node + wp.uint32(3)))
            s.tolerance = 1e-5 * s.radius
        s = blob_device_advance(buffer, v, s, there)
        if s.stage >= BLOB_DEVICE_FOUND:
            break
    sample = blob_device_report(s, sample)
    return cursor, sample


@wp.kernel
def blob_query_points(
    buffer: wp.array(dtype=wp.uint32),
    vessel: wp.uint32,
    flags: wp.uint32,
    point: wp.array(dtype=wp.vec3),
    cursor: wp.array(dtype=wp.uint32),
    distance: wp.array(dtype=wp.float32),
    normal: wp.array(dtype=wp.vec3),
    value: wp.array(dtype=wp.float32),
    gradient: wp.array(dtype=wp.vec3),
    state: wp.array(dtype=wp.uint32),
):
    """Points, mm; cursors are read and moved. Answers of blob_device_query(): distance in mm and
    outward normal, f and its gradient, BLOB_DEVICE_INSIDE or 0."""
    i = wp.tid()
    sample = blob_device_sample()
    node = cursor[i]
    node, sample = blob_device_query(buffer, wp.uint32(0), vessel, flags, point[i], node, sample)
    cursor[i] = node
    distance[i] = sample.distance
    normal[i] = sample.normal
    value[i] = sample.value
    gradient[i] = sample.gradient
    state[i] = sample.state


@wp.kernel
def blob_query_exact_points(
    buffer: wp.array(dtype=wp.uint32),
    vessel: wp.uint32,
    flags: wp.uint32,
    point: wp.array(dtype=wp.vec3),
    cursor: wp.array(dtype=wp.uint32),
    distance: wp.array(dtype=wp.float32),
    normal: wp.array(dtype=wp.vec3),
    value: wp.array(dtype=wp.float32),
    gradient: wp.array(dtype=wp.vec3),
    state: wp.array(dtype=wp.uint32),
):
    """Points, mm; cursors are read and moved. Answers of blob_device_query_exact(): distance in mm and
    outward normal, f and its gradient, BLOB_DEVICE_INSIDE and _NOT_CONVERGED."""
    i = wp.tid()
    sample = blob_device_sample()
    node = cursor[i]
    node, sample = blob_device_query_exact(buffer, wp.uint32(0), vessel, flags, point[i], node, sample)
    cursor[i] = node
    distance[i] = sample.distance
    normal[i] = sample.normal
    value[i] = sample.value
    gradient[i] = sample.gradient
    state[i] = sample.state
