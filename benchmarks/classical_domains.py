"""Classical planning domains with generators of random tasks.

The domains' ideas are those of the planning competitions, the text is ours.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from random import Random

from benchmarks.pddl_task import Task, problem
from benchmarks.quantified_domains import miconic, network

BLOCKS = """
(define (domain blocks)
  (:requirements :typing :equality :negative-preconditions)
  (:types block)
  (:predicates (on ?a ?b - block) (on-table ?a - block) (clear ?a - block) (holding ?a - block) (empty))
  (:action pick :parameters (?a - block) :precondition (and (clear ?a) (on-table ?a) (empty))
    :effect (and (holding ?a) (not (clear ?a)) (not (on-table ?a)) (not (empty))))
  (:action drop :parameters (?a - block) :precondition (holding ?a)
    :effect (and (not (holding ?a)) (clear ?a) (on-table ?a) (empty)))
  (:action stack :parameters (?a ?b - block) :precondition (and (holding ?a) (clear ?b))
    :effect (and (not (holding ?a)) (not (clear ?b)) (clear ?a) (on ?a ?b) (empty)))
  (:action unstack :parameters (?a ?b - block) :precondition (and (on ?a ?b) (clear ?a) (empty))
    :effect (and (holding ?a) (clear ?b) (not (on ?a ?b)) (not (clear ?a)) (not (empty)))))
"""


def blocks(size: int, rng: Random) -> Task:
    """`size` blocks in random towers are to become other random towers."""
    names = [f"b{i}" for i in range(size)]

    def towers() -> list[list[str]]:
        order = rng.sample(names, size)
        found: list[list[str]] = []
        while order:
            height = rng.randint(1, len(order))
            found.append(order[:height])
            order = order[height:]
        return found

    init = ["(empty)"]
    for tower in towers():
        init += [f"(on-table {tower[0]})", f"(clear {tower[-1]})"]
        init += [f"(on {above} {below})" for below, above in pairwise(tower)]
    goal = [f"(on {up} {low})" for tower in towers() for low, up in pairwise(tower)]
    return BLOCKS, problem("blocks", f"{' '.join(names)} - block", init, goal or [f"(on-table {names[0]})"])


LOGISTICS = """
(define (domain logistics)
  (:requirements :typing)
  (:types truck plane - vehicle package vehicle - thing airport - place city place thing)
  (:predicates (at ?t - thing ?p - place) (in ?k - package ?v - vehicle) (within ?p - place ?c - city))
  (:action load :parameters (?k - package ?v - vehicle ?p - place) :precondition (and (at ?k ?p) (at ?v ?p))
    :effect (and (in ?k ?v) (not (at ?k ?p))))
  (:action unload :parameters (?k - package ?v - vehicle ?p - place) :precondition (and (in ?k ?v) (at ?v ?p))
    :effect (and (at ?k ?p) (not (in ?k ?v))))
  (:action drive :parameters (?t - truck ?a ?b - place ?c - city)
    :precondition (and (at ?t ?a) (within ?a ?c) (within ?b ?c)) :effect (and (at ?t ?b) (not (at ?t ?a))))
  (:action fly :parameters (?t - plane ?a ?b - airport) :precondition (at ?t ?a)
    :effect (and (at ?t ?b) (not (at ?t ?a)))))
"""


def logistics(size: int, rng: Random) -> Task:
    """`size` packages go between places of several cities, each with a truck and an airport; planes fly."""
    cities = [f"c{i}" for i in range(2 + size // 4)]
    places = {city: [f"{city}-airport", *(f"{city}-p{i}" for i in range(1 + size // 6))] for city in cities}
    everywhere = [place for some in places.values() for place in some]
    packages = [f"k{i}" for i in range(size)]
    planes = [f"plane{i}" for i in range(1 + size // 10)]
    init = [f"(within {place} {city})" for city, some in places.items() for place in some]
    init += [f"(at truck-{city} {rng.choice(places[city])})" for city in cities]
    init += [f"(at {plane} {rng.choice(cities)}-airport)" for plane in planes]
    goal: list[str] = []
    for package in packages:
        start, end = rng.sample(everywhere, 2)
        init.append(f"(at {package} {start})")
        goal.append(f"(at {package} {end})")
    objects = f"{' '.join(packages)} - package {' '.join(planes)} - plane {' '.join(cities)} - city "
    objects += " ".join(f"truck-{city}" for city in cities) + " - truck "
    objects += " ".join(f"{city}-airport" for city in cities) + " - airport "
    objects += " ".join(place for some in places.values() for place in some[1:]) + " - place"
    return LOGISTICS, problem("logistics", objects, init, goal)


GRIPPER = """
(define (domain gripper)
  (:predicates (room ?r) (ball ?b) (hand ?h) (robot-at ?r) (at ?b ?r) (free ?h) (carry ?b ?h))
  (:action move :parameters (?a ?b) :precondition (and (room ?a) (room ?b) (robot-at ?a))
    :effect (and (robot-at ?b) (not (robot-at ?a))))
  (:action pick :parameters (?b ?r ?h)
    :precondition (and (ball ?b) (room ?r) (hand ?h) (at ?b ?r) (robot-at ?r) (free ?h))
    :effect (and (carry ?b ?h) (not (at ?b ?r)) (not (free ?h))))
  (:action drop :parameters (?b ?r ?h) :precondition (and (room ?r) (carry ?b ?h) (robot-at ?r))
    :effect (and (at ?b ?r) (free ?h) (not (carry ?b ?h)))))
"""


def gripper(size: int, rng: Random) -> Task:
    """`size` balls go from one room to another, two at a time."""
    balls = [f"ball{i}" for i in range(size)]
    init = ["(room a)", "(room b)", "(hand left)", "(hand right)", "(free left)", "(free right)", "(robot-at a)"]
    init += [text for ball in balls for text in (f"(ball {ball})", f"(at {ball} a)")]
    return GRIPPER, problem("gripper", f"a b left right {' '.join(balls)}", init, [f"(at {ball} b)" for ball in balls])


ROVERS = """
(define (domain rovers)
  (:requirements :typing :action-costs)
  (:types rover waypoint store camera objective)
  (:predicates (at ?r - rover ?w - waypoint) (way ?r - rover ?a ?b - waypoint) (sees ?a ?b - waypoint)
    (lander ?w - waypoint) (sample-at ?w - waypoint)
    (empty ?s - store) (full ?s - store) (store-of ?s - store ?r - rover)
    (have ?r - rover ?w - waypoint) (told ?w - waypoint) (on-board ?c - camera ?r - rover) (calibrated ?c - camera)
    (target ?c - camera ?o - objective) (visible ?o - objective ?w - waypoint) (image ?r - rover ?o - objective)
    (shown ?o - objective))
  (:functions (total-cost) (length ?a ?b - waypoint))
  (:action drive :parameters (?r - rover ?a ?b - waypoint) :precondition (and (at ?r ?a) (way ?r ?a ?b))
    :effect (and (at ?r ?b) (not (at ?r ?a)) (increase (total-cost) (length ?a ?b))))
  (:action dig :parameters (?r - rover ?s - store ?w - waypoint)
    :precondition (and (at ?r ?w) (sample-at ?w) (store-of ?s ?r) (empty ?s))
    :effect (and (full ?s) (not (empty ?s)) (have ?r ?w) (not (sample-at ?w)) (increase (total-cost) 3)))
  (:action dump :parameters (?r - rover ?s - store) :precondition (and (store-of ?s ?r) (full ?s))
    :effect (and (empty ?s) (not (full ?s)) (increase (total-cost) 1)))
  (:action calibrate :parameters (?r - rover ?c - camera ?o - objective ?w - waypoint)
    :precondition (and (on-board ?c ?r) (target ?c ?o) (at ?r ?w) (visible ?o ?w))
    :effect (and (calibrated ?c) (increase (total-cost) 2)))
  (:action photograph :parameters (?r - rover ?c - camera ?o - objective ?w - waypoint)
    :precondition (and (calibrated ?c) (on-board ?c ?r) (at ?r ?w) (visible ?o ?w))
    :effect (and (image ?r ?o) (not (calibrated ?c)) (increase (total-cost) 1)))
  (:action tell :parameters (?r - rover ?w ?at ?l - waypoint)
    :precondition (and (have ?r ?w) (at ?r ?at) (lander ?l) (sees ?at ?l))
    :effect (and (told ?w) (increase (total-cost) 4)))
  (:action show :parameters (?r - rover ?o - objective ?at ?l - waypoint)
    :precondition (and (image ?r ?o) (at ?r ?at) (lander ?l) (sees ?at ?l))
    :effect (and (shown ?o) (increase (total-cost) 6))))
"""


def rovers(size: int, rng: Random) -> Task:
    """Rovers dig at `size` places and photograph half as many things; driving costs by length."""
    rovers_ = [f"r{i}" for i in range(1 + size // 5)]
    points = [f"w{i}" for i in range(size + 3)]
    things = [f"o{i}" for i in range(max(1, size // 2))]
    init = ["(lander w0)", *(f"(sees {point} w0)" for point in points if rng.random() < 0.5 or point in ("w0", "w1"))]
    for i, point in enumerate(points):
        for j, other in enumerate(points):
            if abs(i - j) == 1 or (i != j and rng.random() < 0.1):
                init.append(f"(= (length {point} {other}) {rng.randint(1, 9)})")
                init += [f"(way {rover} {point} {other})" for rover in rovers_]
    init += [f"(sample-at {point})" for point in points[3:]]
    for rover in rovers_:
        init += [f"(at {rover} {rng.choice(points)})", f"(store-of s{rover} {rover})", f"(empty s{rover})"]
        init += [f"(on-board c{rover} {rover})", f"(target c{rover} {rng.choice(things)})"]
    init += [f"(visible {thing} {point})" for thing in things for point in rng.sample(points, 2)]
    goal = [f"(told {point})" for point in points[3:]] + [f"(shown {thing})" for thing in things]
    objects = f"{' '.join(rovers_)} - rover {' '.join(points)} - waypoint {' '.join(things)} - objective "
    objects += f"{' '.join('s' + r for r in rovers_)} - store {' '.join('c' + r for r in rovers_)} - camera"
    return ROVERS, problem("rovers", objects, init, goal, metric=True)


SATELLITE = """
(define (domain satellite)
  (:requirements :typing :equality :negative-preconditions)
  (:types satellite direction instrument mode)
  (:predicates (on-board ?i - instrument ?s - satellite) (supports ?i - instrument ?m - mode)
    (pointing ?s - satellite ?d - direction) (power ?s - satellite) (on ?i - instrument) (calibrated ?i - instrument)
    (image ?d - direction ?m - mode) (target ?i - instrument ?d - direction))
  (:action turn :parameters (?s - satellite ?a ?b - direction) :precondition (and (pointing ?s ?b) (not (= ?a ?b)))
    :effect (and (pointing ?s ?a) (not (pointing ?s ?b))))
  (:action switch-on :parameters (?i - instrument ?s - satellite) :precondition (and (on-board ?i ?s) (power ?s))
    :effect (and (on ?i) (not (calibrated ?i)) (not (power ?s))))
  (:action switch-off :parameters (?i - instrument ?s - satellite) :precondition (and (on-board ?i ?s) (on ?i))
    :effect (and (not (on ?i)) (power ?s)))
  (:action calibrate :parameters (?s - satellite ?i - instrument ?d - direction)
    :precondition (and (on-board ?i ?s) (target ?i ?d) (pointing ?s ?d) (on ?i)) :effect (calibrated ?i))
  (:action take :parameters (?s - satellite ?d - direction ?i - instrument ?m - mode)
    :precondition (and (calibrated ?i) (on-board ?i ?s) (supports ?i ?m) (on ?i) (pointing ?s ?d))
    :effect (image ?d ?m)))
"""


def satellite(size: int, rng: Random) -> Task:
    """Satellites with instruments of different modes take `size` images."""
    satellites = [f"s{i}" for i in range(1 + size // 4)]
    directions = [f"d{i}" for i in range(size + 2)]
    modes = [f"m{i}" for i in range(2 + size // 5)]
    instruments = [f"i{i}" for i in range(max(len(modes), len(satellites)))]
    init = [text for s in satellites for text in (f"(power {s})", f"(pointing {s} {rng.choice(directions)})")]
    for number, instrument in enumerate(instruments):
        carrier = satellites[number % len(satellites)]
        init += [f"(on-board {instrument} {carrier})", f"(target {instrument} {rng.choice(directions)})"]
        init += [f"(supports {instrument} {m})" for m in {modes[number % len(modes)], rng.choice(modes)}]
    goal = [f"(image {direction} {rng.choice(modes)})" for direction in directions[2:]]
    objects = f"{' '.join(satellites)} - satellite {' '.join(directions)} - direction "
    objects += f"{' '.join(instruments)} - instrument {' '.join(modes)} - mode"
    return SATELLITE, problem("satellite", objects, init, goal)


DEPOT = """
(define (domain depot)
  (:requirements :typing)
  (:types place thing - object pallet crate - surface hoist truck surface - thing)
  (:predicates (at ?t - thing ?p - place) (on ?c - crate ?s - surface) (in ?c - crate ?t - truck) (clear ?s - surface)
    (lifting ?h - hoist ?c - crate) (free ?h - hoist))
  (:action drive :parameters (?t - truck ?a ?b - place) :precondition (at ?t ?a)
    :effect (and (at ?t ?b) (not (at ?t ?a))))
  (:action lift :parameters (?h - hoist ?c - crate ?s - surface ?p - place)
    :precondition (and (at ?h ?p) (at ?c ?p) (free ?h) (on ?c ?s) (clear ?c))
    :effect (and (lifting ?h ?c) (clear ?s) (not (at ?c ?p)) (not (free ?h)) (not (on ?c ?s)) (not (clear ?c))))
  (:action put :parameters (?h - hoist ?c - crate ?s - surface ?p - place)
    :precondition (and (at ?h ?p) (at ?s ?p) (clear ?s) (lifting ?h ?c))
    :effect (and (free ?h) (at ?c ?p) (clear ?c) (on ?c ?s) (not (lifting ?h ?c)) (not (clear ?s))))
  (:action load :parameters (?h - hoist ?c - crate ?t - truck ?p - place)
    :precondition (and (at ?h ?p) (at ?t ?p) (lifting ?h ?c)) :effect (and (in ?c ?t) (free ?h) (not (lifting ?h ?c))))
  (:action unload :parameters (?h - hoist ?c - crate ?t - truck ?p - place)
    :precondition (and (at ?h ?p) (at ?t ?p) (free ?h) (in ?c ?t))
    :effect (and (lifting ?h ?c) (not (in ?c ?t)) (not (free ?h)))))
"""


def depot(size: int, rng: Random) -> Task:
    """`size` crates, stacked on pallets, go to other stacks at other places by truck."""
    places = [f"p{i}" for i in range(2 + size // 3)]
    crates = [f"c{i}" for i in range(size)]

    def stacks() -> list[list[str]]:
        found: list[list[str]] = [[f"pallet-{place}"] for place in places]
        for crate in rng.sample(crates, size):
            rng.choice(found).append(crate)
        return found

    init = [f"(at truck{i} {rng.choice(places)})" for i in range(2)]
    for place, stack in zip(places, stacks(), strict=True):
        init += [f"(at hoist-{place} {place})", f"(free hoist-{place})", f"(clear {stack[-1]})"]
        init += [f"(at {thing} {place})" for thing in stack]
        init += [f"(on {up} {low})" for low, up in pairwise(stack)]
    goal = [f"(on {up} {low})" for stack in stacks() for low, up in pairwise(stack)]
    objects = f"{' '.join(places)} - place {' '.join(crates)} - crate truck0 truck1 - truck "
    objects += (
        " ".join(f"pallet-{p}" for p in places) + " - pallet " + " ".join(f"hoist-{p}" for p in places) + " - hoist"
    )
    return DEPOT, problem("depot", objects, init, goal)


GENERATORS: dict[str, Callable[[int, Random], Task]] = {
    "blocks": blocks,
    "logistics": logistics,
    "gripper": gripper,
    "rovers": rovers,
    "satellite": satellite,
    "depot": depot,
    "miconic": miconic,
    "network": network,
}
"""By the domain's name: a task of a size."""
