"""The emulated CNC: program text in, setpoints out. Knows neither physics nor geometry.

- Outside: `cnc.Controller` on a clock shared with a machine (`clock`), `dry_run.dry_run` without one;
  `trace`, `read_on`, `observed` for who wants to look closer. `execution` runs language and motion in step;
  `commands` are what passes from the one to the other.
- `tables/`: alarms, codes, parameters, signals; `machine_data` is what parameters make of the lathe.
- `language/`: `source` and `folder` → `lexer` → `syntax` → `interpreter` (`flow`, `blocks`, a module of
  `families/` for every family of codes, `macro/`, `cycles/`) → commands; `plain_lane` is the short way of
  plain blocks.
- `laws/`, pure functions: `gearbox`, `angle_table`, `inclined`, `segments`, `wave`, `arcs`, `stroke_area`.
- `motion/`: `axes` ← `paths` ← `settling` ← `travel` ← `turning` ← `manual` ← `returning` ← `correcting`
  ← `motion`; `timeline` holds what is planned, `sampling` reads it tick by tick.
- `operator/`: `actions` in words, the `panel`, the `agenda` of what is still to come.
"""
