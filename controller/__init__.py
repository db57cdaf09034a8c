"""The emulated CNC: program text in, setpoints out. Knows neither physics nor geometry.

- Outside: `cnc.Controller` on a clock shared with a machine (`clock`), `dry_run.dry_run` without one;
  `trace`, `read_on`, `observed` for who wants to look closer.
- Tables: `alarms`, `codes`, `parameters`, `signals`, `operator`; `machine_data` is what parameters make of
  the lathe.
- Language: `source` and `folder` → `lexer` → `syntax` → `interpreter` (`flow`, `blocks`, a `*_blocks` module
  for every family of codes, `macro/`, `cycles/`) → `commands`; `plain_lane` is the short way of plain blocks.
- Laws, pure functions: `gearbox`, `inclined`, `segments`, `wave`, `stroke_area`.
- Motion: `axes` ← `paths` ← `settling` ← `travel` ← `turning` ← `manual` ← `returning` ← `motion`;
  `timeline` holds what is planned, `sampling` reads it tick by tick.
- Operator: `panel`, `agenda`, `manual`.
"""
