"""The arguments of G65 and G66: which letter sets which local variable (rulings, section 1)."""

from collections.abc import Iterable

LETTERS = {
    "A": 1,
    "B": 2,
    "C": 3,
    "I": 4,
    "J": 5,
    "K": 6,
    "D": 7,
    "E": 8,
    "F": 9,
    "H": 11,
    "M": 13,
    "Q": 17,
    "R": 18,
    "S": 19,
    "T": 20,
    "U": 21,
    "V": 22,
    "W": 23,
    "X": 24,
    "Y": 25,
    "Z": 26,
}
"""first argument list: letter -> number of the local variable"""
TRIPLE = "IJK"
"""second argument list: A1 B2 C3, then ten times I J K, from #4 on"""
MOST_TRIPLES = 10
COUNTED = frozenset("DEFHMST")
"""letters whose number without a point is taken as it stands whatever the increment system"""


def argument_numbers(letters: Iterable[str]) -> list[int | None]:
    """The local variable each letter of a call sets, in the order they are written; None = no such argument.

    The second list begins a new triple whenever the alphabet goes back: I J K I J gives #4 #5 #6 #7 #8.
    """
    numbers: list[int | None] = []
    triple, last = 0, -1
    for letter in letters:
        if letter in TRIPLE:
            place = TRIPLE.index(letter)
            if place <= last:
                triple += 1
            last = place
            numbers.append(4 + 3 * triple + place if triple < MOST_TRIPLES else None)
        else:
            numbers.append(LETTERS.get(letter))
    return numbers
