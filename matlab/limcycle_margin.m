function result = limcycle_margin (what, varargin)
% LIMCYCLE_MARGIN  How far each number is from the edge of hunting.
%   RESULT = LIMCYCLE_MARGIN (CASE, NAME, VALUE, ...): see LIMCYCLE.
  result = limcycle ('margin', what, varargin{:});
end
