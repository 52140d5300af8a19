"""A map on many ranks, simulated event by event: one writer that serves messages in order, and ranks that hold one piece in
the making and one more. The rules are those of cli/rank_sweep.cpp."""
import bisect
import heapq
import itertools
from dataclasses import dataclass

PIECE_SECONDS = 0.05   # piece_seconds of cli/rank_sweep.cpp
WRITER_SECONDS = 1e-4  # writer_seconds


@dataclass
class Costs:
    message: float  # s of the writer for each message and its answer
    row: float      # s of the writer for each row: into the store and the map
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

    def seconds(self, first, count):
        return self.sums[first + count] - self.sums[first]

    def total(self):
        return self.sums[-1]


def piece_by_rule(pace, left, ranks):
    if pace <= 0.0:
        return 1
    return max(1, min(int((PIECE_SECONDS + WRITER_SECONDS * ranks) / pace), left // (4 * ranks)))


def simulate(the_map, ranks, costs, block=None, speed=1.0):
    """(wall time, busy time of the writer, messages) of a map. `block`: points of a piece; None: by the rule of the program.
    `speed`: of each rank, below 1 where ranks share cores."""
    handed = done = messages = 0
    writer = busy = pace = last = 0.0
    held = [0] * ranks
    until = [0.0] * ranks  # when a rank has computed all it holds
    events = [(0.0, rank, 0, 0.0) for rank in range(ranks)]  # arrival at the writer, of whom, rows, seconds of computing
    while events:
        at, rank, rows, seconds = heapq.heappop(events)
        # Rank 0 tells itself without a message.
        service = (costs.message if rank > 0 else 0.0) + costs.row * rows
        writer = max(writer, at) + service
        busy += service
        messages += rank > 0
        if rows:
            held[rank] -= 1
            done += rows
            pace += (seconds / rows - pace) * (0.1 if pace > 0.0 else 1.0)
            last = writer
        while handed < the_map.points:
            left = the_map.points - handed
            if held[rank] >= (2 if left > ranks else 1):
                break
            count = min(block or piece_by_rule(pace, left, ranks), left)
            seconds = the_map.seconds(handed, count) / speed
            handed += count
            held[rank] += 1
            way = costs.way if rank > 0 else 0.0
            until[rank] = max(until[rank], writer + way) + seconds
            heapq.heappush(events, (until[rank] + way, rank, count, seconds))
    assert done == the_map.points
    return last, busy, messages


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


def share_above(values, limit):
    ordered = sorted(values)
    return 1 - bisect.bisect_right(ordered, limit) / len(ordered)
