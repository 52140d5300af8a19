function exchange_test (root, work)
% Called by tools/exchange: results in Octave. ROOT is the source tree, WORK a folder with documents of the program.
  addpath (fullfile (root, 'matlab'));
  documents (work);
  loops (root);
  plants (root, work);
  systems ();
  example (root);
  printf ('exchange: Octave %s: HDF5 equal to JSON, the functions, MAT-files, systems of the package control\n', version ());
end

function documents (work)
  for name = {'predict', 'df', 'map', 'simulate', 'sensitivity'}
    known = jsondecode (fileread (fullfile (work, [name{1}, '.json'])));
    found = load (fullfile (work, [name{1}, '.h5']));
    known = setfield (rmfield (known, 'xCase'), 'case', known.xCase); % a word that Octave reserves
    assert (sort (fieldnames (found)), sort (fieldnames (known)));
    assert (strtrim (found.status), known.status);
  end
  known = jsondecode (fileread (fullfile (work, 'predict.json')));
  found = load (fullfile (work, 'predict.h5'));
  close = -4 * eps; % of JSON Octave may lose the last bit
  assert (found.cycles.period, known.cycles.period, close);
  assert (found.search.amplitude(:), known.search.amplitude(:), close);
  assert (cellstr (found.outcomes.outcome), {known.outcomes.outcome}');
  known = jsondecode (fileread (fullfile (work, 'df.json')));
  found = load (fullfile (work, 'df.h5'));
  gain = [known.points.gain];
  if (size (found.points.gain, 1) == 2) % Octave turns the order of the sizes round
    found.points.gain = found.points.gain';
  end
  assert (found.points.gain, gain', close);
  assert (found.points.amplitude(:), [known.points.amplitude]', close);
end

function loop = servo ()
  loop.plant = struct ('kind', 'mass', 'mass', 1.0);
  loop.controller = struct ('kind', 'pid', 'kp', 3.0, 'ki', 4.0, 'kd', 6.0);
  loop.friction = struct ('kind', 'lugre', 'Fs', 1.5, 'Fc', 1.0, 'vs', 0.001, ...
                          'sigma0', 1e5, 'sigma1', 316.22776601683796, 'sigma2', 0.4);
end

function loops (root)
  loop = servo ();
  result = limcycle_predict (loop);
  assert (result.exit_code, 0);
  assert (result.cycles.period, 24.4368, 1e-3);
  assert (~ isempty (strfind (result.text, 'This loop hunts')));
  whole = limcycle ('predict', fullfile (root, 'cases', 'pid-lugre.toml'), 'seed', 3);
  assert (whole.cycles.period, result.cycles.period, -1e-6);
  assert (whole.provenance.seed, 3);
  changed = limcycle_predict (loop, 'set', {'loop.controller.ki=0.0', 'loop.plant.mass=2.0'}, 'verbose', true);
  assert (isempty (changed.cycles));
  assert (~ isempty (strfind (changed.text, 'Work done')));
  run = limcycle_simulate (struct ('loop', loop, 'simulate', struct ('duration', 2, 'initial', struct ('y', 0.1))));
  assert (run.rows(1, strcmp (run.columns, 'y')), 0.1);
  table = limcycle_df (struct ('loop', struct ('friction', loop.friction), ...
                               'df', struct ('amplitude', [1e-5, 1e-3], 'frequency', 2)));
  assert (numel (table.points), 2);
  slipping = struct ('kind', 'gms', 'Fs', 1.5, 'Fc', 1, 'vs', 1e-3, 'k', [6e4, 4e4], 'alpha', [0.5, 0.5], 'C', 100);
  gms = limcycle_df (struct ('loop', struct ('friction', slipping), 'df', struct ('amplitude', 1e-4, 'frequency', 2)));
  assert (gms.points.status, 'converged');
  w = logspace (-1, 2, 60)';
  G = (1i * w + 1) .^ -3;
  measured = struct ('plant', struct ('kind', 'frf', 'frequency', 'rad/s', 'format', 're-im', ...
                                      'points', [w, real(G), imag(G)]), 'element', struct ('kind', 'relay', 'level', 1));
  assert (limcycle_predict (measured).cycles.period, 3.67975, 1e-3);
  edge = limcycle_margin (loop, 'parameter', 'loop.controller.ki');
  assert (strcmp (edge.command, 'margin'));
  loop.title = 'a "quoted" name, a \ and Größe';
  loop = struct ('title', loop.title, 'loop', rmfield (loop, 'title'));
  assert (limcycle_predict (loop).xCase.title, loop.title);
  refused (@() limcycle_predict (setfield (servo (), 'friction', 'kind', 'lugr')), 'did you mean "lugre"');
  refused (@() limcycle_predict (setfield (servo (), 'plant', 'mass', -1)), 'must be > 0 kg');
  refused (@() limcycle ('predict', servo (), 'seed'), 'name, value');
  refused (@() limcycle ('predict', setfield (servo (), 'load', @sin)), 'load: a function_handle');
end

function plants (root, work)
  A = [0, 1; 0, 0]; B = [0; 1]; C = [1, 0];
  loop = servo ();
  known = limcycle_predict (loop).cycles.period;
  loop.plant = struct ('kind', 'state-space', 'A', A, 'B', B, 'C', C);
  assert (limcycle_predict (loop).cycles.period, known, -1e-7);
  for version = {'-v4', '-v6', '-v7'}
    save (version{1}, fullfile (work, 'plant.mat'), 'A', 'B', 'C', 'known');
    assert (limcycle_predict (fullfile (work, 'mat.toml')).cycles.period, known, -1e-7);
  end
end

function systems ()
  pkg load control
  loop.element = struct ('kind', 'relay', 'level', 1);
  loop.plant = struct ('kind', 'transfer-function', 'numerator', 1, 'denominator', [1, 3, 3, 1]);
  known = limcycle_predict (loop).cycles.period;
  assert (known, 3.67975, 1e-4);
  for system = {tf(1, [1, 3, 3, 1]), ss(tf (1, [1, 3, 3, 1])), zpk([], [-1, -1, -1], 1)}
    loop.plant = system{1};
    assert (limcycle_predict (loop).cycles.period, known, -1e-6);
  end
  loop.plant = struct ('kind', 'zpk', 'zeros', [], 'poles', [-1, -0.5 + 2i, -0.5 - 2i], 'gain', 1);
  limcycle_predict (loop);
  loop.plant = c2d (tf (1, [1, 3, 3, 1]), 0.1);
  refused (@() limcycle_predict (loop), 'discrete time');
end

function example (root)
  page = fileread (fullfile (root, 'docs', 'matlab.md'));
  code = regexp (page, '```matlab\naddpath [^\n]*\n(.*?)```', 'tokens', 'once');
  eval (regexprep (code{1}, '(result\.\w[\w.]*) +%', '$1; %')); % without its output
  shown = regexp (page, 'result\.cycles\.period *% ([0-9.]+)', 'tokens', 'once');
  assert (result.cycles.period, str2double (shown{1}), 0.005);
end

function refused (question, part)
  try
    question ();
  catch problem
    assert (strcmp (problem.identifier, 'limcycle:input'), problem.message);
    assert (~ isempty (strfind (problem.message, part)), problem.message);
    return;
  end
  error ('not refused: %s', part);
end
