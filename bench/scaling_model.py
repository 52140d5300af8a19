"""A map on many ranks, simulated event by event: one writer that serves messages in order, and ranks that hold one piece in
the making and one more. The rules are those of cli/ranks/rank_sweep.cpp."""
import bisect
import collections
import heapq
import itertools
import math
from dataclasses import dataclass

PIECE_SECONDS = 0.05   # piece_seconds of cli/ranks/rank_sweep.cpp
WRITER_SECONDS = 1e-4  # writer_seconds
PATIENCE = 1.5         # patience


@dataclass
class Costs:
    message: float  # s of the writer for each message and its answer, with handing its rows to the store
    wake: float     # s of the store's thread for each message
    row: float      # and for each row
    way: float      # s from a rank to the writer or back


def finer(seconds, width, times):
    """The times of a map with `times` as many points along both sides: neighbours cost alike."""
    rows = [seconds[i:i + width] for i in range(0, len(seconds), width)]
    return [value for row in rows for _ in range(times) for value in row for _ in range(times)]


class Map:
    """Times of all points in order, as sums, so that a piece costs one subtraction."""

    def __init__(self, seconds):
        self.sums = list(itertools.accumulate(seconds, initial=0.0))
        self.points = len(seconds)

    def total(self):
        return self.sums[-1]

    def computed(self, first, count, limit):
        """(points, seconds): how far a rank comes with a piece of which it begins no point after `limit`."""
        end = bisect.bisect_right(self.sums, self.sums[first] + limit, first + 1, first + count)
        return end - first, self.sums[end] - self.sums[first]


class Writer:
    """Which points are handed out next. `block`: points of a piece; None: by the rule of the program."""

    def __init__(self, the_map, ranks, block):
        self.map, self.ranks, self.block = the_map, ranks, block
        self.handed = 0
        self.left = the_map.points
        self.returned = collections.deque()
        self.pace = 0.0
        self.meant = PIECE_SECONDS + WRITER_SECONDS * ranks

    def limit(self):
        return math.inf if self.block else PATIENCE * self.meant

    def next_piece(self):
        """(first, count)"""
        if self.returned:
            first, count = self.returned.popleft()
            if count > 1:
                self.returned.appendleft((first + 1, count - 1))
            count = 1
        else:
            most = max(1.0, self.left // (2 * self.ranks))
            wanted = self.block or (min(max(self.meant / self.pace, 1.0), most) if self.pace > 0 else 1)
            first, count = self.handed, min(int(wanted), self.map.points - self.handed)
            self.handed += count
        self.left -= count
        return first, count

    def take(self, rows, seconds, rest):
        self.pace += (seconds / rows - self.pace) * (0.1 if self.pace > 0.0 else 1.0)
        if rest[1]:
            self.returned.append(rest)
            self.left += rest[1]


def simulate(the_map, ranks, costs, block=None, speed=1.0):
    """(wall time, busy time of the writer, of the store, messages) of a map. `speed`: of each rank, below 1 where ranks share
    cores."""
    writer = Writer(the_map, ranks, block)
    free = busy = 0.0             # when the writer has served all that arrived; how long it served
    stored = storing = 0.0        # the same of the store, whose queue is long
    messages = done = 0
    held = [0] * ranks
    until = [0.0] * ranks  # when a rank has computed all it holds
    idle = set()
    events = [(0.0, rank, None) for rank in range(ranks)]  # arrival at the writer, of whom, with what

    def hand_out(rank):
        while writer.left and held[rank] < (2 if writer.left > ranks else 1):
            first, count = writer.next_piece()
            points, seconds = the_map.computed(first, count, writer.limit() * speed)
            way = costs.way if rank > 0 else 0.0
            held[rank] += 1
            until[rank] = max(until[rank], free + way) + seconds / speed
            heapq.heappush(events, (until[rank] + way, rank, (points, seconds / speed, (first + points, count - points))))
        if held[rank] == 0:
            idle.add(rank)

    while events:
        at, rank, piece = heapq.heappop(events)
        service = costs.message if rank > 0 else 0.0  # rank 0 tells itself without a message
        free = max(free, at) + service
        busy += service
        messages += rank > 0
        if piece:
            held[rank] -= 1
            done += piece[0]
            writer.take(*piece)
            work = costs.wake + costs.row * piece[0]
            stored = max(stored, free) + work
            storing += work
        hand_out(rank)
        while idle and writer.left:
            hand_out(idle.pop())
    assert done == the_map.points
    return stored, busy, storing, messages


def efficiency(the_map, ranks, costs, block=None):
    return the_map.total() / (ranks * simulate(the_map, ranks, costs, block)[0])


def bend(counts, efficiencies, limit=0.8):
    """Number of ranks at which the efficiency falls below `limit`, between the counts tried; None if it does not."""
    for (n1, e1), (n2, e2) in itertools.pairwise(zip(counts, efficiencies)):
        if e1 >= limit > e2:
            return n1 * (n2 / n1) ** ((e1 - limit) / (e1 - e2))
    return None


def quantiles(values, shares):
    ordered = sorted(values)
    return [ordered[min(len(ordered) - 1, int(share * len(ordered)))] for share in shares]

